// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/database.hpp>

namespace steadyrest::record {

/// The writer never puts more samples into a chunk, or segments into a part of a path.
inline constexpr std::int64_t kMostInPart = 1 << 20;

/// A record, for reading. Refuses what is no record, has another format, or is cut off.
[[nodiscard]] kernel::outcome::Result<Database> open_record(const std::string& file);

/// A record as it is now, in a new file, whole also while it is being written. Refuses a file that
/// exists and has contents.
[[nodiscard]] kernel::outcome::Result<void> copy_record(const std::string& file,
                                                        const std::string& copy);

}  // namespace steadyrest::record
