// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/read/text/landmark.hpp>

namespace steadyrest::nc::read {

/// What a line of `fanuc` means for the map of its file: block number, program number, IF … GOTO,
/// GOTO, WHILE … DO, DO, END, M99. Never allocates.
[[nodiscard]] Landmark macro_landmark(std::string_view line) noexcept;

}  // namespace steadyrest::nc::read
