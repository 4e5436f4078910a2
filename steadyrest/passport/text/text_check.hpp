// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// A machine file is a few kilobytes, or ten megabytes with the longest table of encoder lines;
/// anything larger than this is some other file.
inline constexpr std::size_t kMaxFileBytes = 16U << 20U;

/// Requirements on the text before it goes to the TOML parser: not empty, not oversized, UTF-8, no
/// control characters, no key path deep enough to exhaust the stack. `file` of the refusal stays
/// empty.
[[nodiscard]] std::optional<kernel::outcome::Refusal> unfit_text(std::string_view text);

}  // namespace steadyrest::passport
