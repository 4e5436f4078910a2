// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// What a read-only named parameter of LinuxCNC shows of the modal state.
struct Answer {
  double (*value)(const State&) = nullptr;
  ModeMask mode = 0;  ///< the modes it follows from
};
/// By the name without `<` and `>`; nullptr where it is none of them.
[[nodiscard]] const Answer* answer_of(std::string_view name);

}  // namespace steadyrest::nc::interpret
