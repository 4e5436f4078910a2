// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// The word of an axis in mm or degrees.
[[nodiscard]] double component(const Step& step, std::size_t axis, const State& state) noexcept;

[[nodiscard]] Axes to_machine(const State& state, const Axes& work) noexcept;
[[nodiscard]] Axes to_work(const State& state, const Axes& machine) noexcept;

/// To be called after any offset change. The machine stays where it is: the work position takes up
/// the difference.
///
///   machine = R·(position + g92) + work offset + frame + tool
///
/// with R the rotation of the work offset and of sinumerik's programmed frame.
void update_offset(State& state) noexcept;

/// Where the block's words lead, in work coordinates; unnamed axes stay.
[[nodiscard]] Axes end_point(const Step& step, const Control& control) noexcept;

/// Applies @ and ^ to `point`: the distance from the origin and the angle, each the present one if
/// omitted; in G91 both are added. Always in the XY plane, as on LinuxCNC.
void polar_point(const Step& step, const State& state, Axes& point) noexcept;

/// LinuxCNC 2.9 removes the tool offset for machine coordinates, except for A, B and C.
[[nodiscard]] bool tool_stays(const DialectRules& rules, std::size_t axis) noexcept;

/// linuxcnc: where an axis with WRAPPED_ROTARY goes for the angle `wanted_deg` (offsets taken off);
/// the sign of `written_deg`, as the program has it, is the direction. LinuxCNC 2.9's law, measured
/// with rs274.
[[nodiscard]] double within_turn(double written_deg, double wanted_deg, double now_deg) noexcept;
[[nodiscard]] bool is_wrapped(const Control& control, std::size_t axis) noexcept;

}  // namespace steadyrest::nc::interpret
