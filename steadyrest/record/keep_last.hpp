// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::record {

/// Copies the last transactions of a run, at least `seconds` of it where there is so much, with its
/// paths and all its events into a record of their own. The run may still be written. Refuses a
/// target that exists.
[[nodiscard]] kernel::outcome::Result<void> keep_last(const std::string& run,
                                                      const std::string& kept, double seconds);

}  // namespace steadyrest::record
