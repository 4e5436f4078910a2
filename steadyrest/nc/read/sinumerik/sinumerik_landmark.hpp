// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/read/text/landmark.hpp>

namespace steadyrest::nc::read {

/// What a line of `sinumerik` means for the map of its file: the head `%_N_NAME_SPF` of a program,
/// block number, label, jump, head or end of a structure, M17 or RET. Never allocates.
[[nodiscard]] Landmark sinumerik_landmark(std::string_view line) noexcept;

}  // namespace steadyrest::nc::read
