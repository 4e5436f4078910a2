// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// Modal group of a G code (times ten); nothing where the code is not interpreted.
struct GroupOfG {
  bool known = false;
  GGroup group = GGroup::non_modal;
};
[[nodiscard]] GroupOfG group_of_g(int code) noexcept;

struct GroupOfM {
  bool known = false;
  MGroup group = MGroup::stopping;
};
[[nodiscard]] GroupOfM group_of_m(int code) noexcept;

/// Why a code from a control's manual is not interpreted here; empty for an unknown code.
[[nodiscard]] std::string_view known_but_refused_g(int code) noexcept;
[[nodiscard]] std::string_view known_but_refused_m(int code) noexcept;

}  // namespace steadyrest::nc::interpret
