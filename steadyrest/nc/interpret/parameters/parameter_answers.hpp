// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// The part of the modal state shown by a read-only named parameter of LinuxCNC.
struct Answer {
  double (*value)(const State&) = nullptr;
  ModeMask mode = 0;  ///< the modes it follows from
};
/// By name without `<` and `>`; nullptr for any other name.
[[nodiscard]] const Answer* answer_of(std::string_view name);

}  // namespace steadyrest::nc::interpret
