// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/check/reach.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {

using plan::Reach;
using plan::reach_of;

inline constexpr std::string_view kAgainstTravel =
    "leave room for the correction: move the work offset or the program, or plan without this axis";

/// The fault when a correction takes a linear axis beyond an end of its travel that the original
/// move respects; empty when there is none. A move beyond the end without the correction is the
/// program's own fault, or shows that the work offset is not the machine's.
[[nodiscard]] std::string over_travel(std::span<const kernel::machine::Axis> axes, char letter,
                                      const Reach& original, const Reach& corrected);
/// The same for a pair of moves and all axes of a plan.
[[nodiscard]] std::string over_travel(std::span<const kernel::machine::Axis> axes, const Plan& plan,
                                      const interpret::Move& original,
                                      const interpret::Move& corrected);

}  // namespace steadyrest::nc::rewrite
