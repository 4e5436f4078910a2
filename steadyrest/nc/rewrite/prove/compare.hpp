// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::rewrite {

/// Two positions of the two programs that count as one, mm or degrees.
inline constexpr double kSame_mm = 1e-9;
[[nodiscard]] inline bool same(double a, double b) noexcept {
  return std::abs(a - b) <= kSame_mm;
}

/// What two moves of paired lines differ in, apart from positions; empty when in nothing.
[[nodiscard]] std::string_view first_difference(const interpret::Move& a, const interpret::Move& b);
[[nodiscard]] bool equal_events(const std::vector<interpret::Event>& a,
                                const std::vector<interpret::Event>& b);
/// What an inserted line must leave unchanged.
struct Modes {
  std::size_t active_offset = 0;
  double rotation_deg = 0.0;
  double unit_mm = 1.0;
  interpret::Plane plane = interpret::Plane::xy;
  bool incremental = false;
  bool centre_absolute = false;
  bool retract_to_initial = false;
  int motion = -1;
  interpret::FeedMode feed_mode = interpret::FeedMode::per_minute;
  double feed_mm_s = 0.0;
  interpret::PathMode path_mode = interpret::PathMode::continuous;
  double path_tolerance_mm = 0.0;
  bool override_off = false;
  double spindle_speed_rev_s = 0.0;
  int spindle_direction = 0;
  bool surface_speed = false;
  double surface_speed_mm_s = 0.0;
  double coolant = 0.0;
  std::int32_t selected_tool = 0;
  std::int32_t tool_in_spindle = 0;
  int cutter_side = 0;
  bool diameter = false;
  bool operator==(const Modes&) const = default;
};
[[nodiscard]] Modes modes_of(const interpret::State& state);
/// Updates `modes` after a line; `moved_alone` as in interpret::ProgramRun.
void renew(Modes& modes, const interpret::State& state, bool moved_alone);

/// What the end states of two programs differ in that the next program would notice; empty when in
/// nothing.
[[nodiscard]] std::string_view state_difference(const interpret::State& a,
                                                const interpret::State& b);

/// The name of anything else that outlives the programs and differs: reference points, stored
/// rotations, the tool table, variables (except those of the inserted lines); empty when nothing.
[[nodiscard]] std::string kept_difference(const interpret::ProgramRun& original,
                                          const interpret::ProgramRun& changed);

}  // namespace steadyrest::nc::rewrite
