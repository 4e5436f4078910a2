// SPDX-License-Identifier: Apache-2.0
// The proof compares all that a correction must leave alone. Each test spoils one thing.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/prove/compare.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::EventKind;
using interpret::FeedMode;
using interpret::Move;
using interpret::MoveKind;
using interpret::PathMode;
using interpret::State;

TEST(FirstDifference, FindsTheOneThingThatWasChanged) {
  const std::pair<const char*, std::function<void(Move&)>> cases[] = {
      {"kind of move", [](Move& m) { m.kind = MoveKind::linear; }},
      {"feed", [](Move& m) { m.feed_mm_s = 1e-12; }},
      {"feed", [](Move& m) { m.feed_mode = FeedMode::inverse_time; }},
      {"arc's plane or turns", [](Move& m) { m.normal[1] = 1.0; }},
      {"arc's plane or turns", [](Move& m) { m.turns = 1; }},
      {"arc's plane or turns", [](Move& m) { m.spline_order = 4; }},
      {"rotation", [](Move& m) { m.rotation_deg = 1e-9; }},
      {"path mode", [](Move& m) { m.path_mode = PathMode::exact_stop; }},
      {"path mode", [](Move& m) { m.path_tolerance_mm = 0.01; }},
      {"spindle speed", [](Move& m) { m.spindle_rev_s = 1.0; }},
      {"spindle speed", [](Move& m) { m.surface_speed_mm_s = 1.0; }},
      {"spindle speed", [](Move& m) { m.spindle_limit_rev_s = 1.0; }},
      {"spindle speed", [](Move& m) { m.speed_modulation = true; }},
      {"override lock", [](Move& m) { m.override_locked = true; }},
      {"dwell", [](Move& m) { m.dwell_s = 0.5; }}};
  const Move original;
  EXPECT_EQ(first_difference(original, original), "");
  for (const auto& [what, spoil] : cases) {
    Move changed;
    spoil(changed);
    EXPECT_EQ(first_difference(original, changed), what);
    EXPECT_EQ(first_difference(changed, original), what);
  }
}

// Positions, lines and offsets change by the correction itself: Shifts judges them.
TEST(FirstDifference, LeavesPositionsToTheShifts) {
  Move changed;
  changed.line = 9;
  changed.start[2] = changed.end[2] = changed.offset[2] = 0.01;
  changed.centre_mm[0] = 5.0;
  EXPECT_EQ(first_difference(Move{}, changed), "");
}

TEST(EqualEvents, AreTheSameInKindValueAndNumber) {
  const std::vector<interpret::Event> events = {
      {.kind = EventKind::spindle, .line = 1, .value = 10}, {.kind = EventKind::stop, .line = 2}};
  auto other = events;
  other[0].line = 7;  // lines differ where text was inserted
  EXPECT_TRUE(equal_events(events, other));
  other[0].value = 11;
  EXPECT_FALSE(equal_events(events, other));
  other = events;
  other[1].kind = EventKind::end;
  EXPECT_FALSE(equal_events(events, other));
  other = events;
  other.pop_back();
  EXPECT_FALSE(equal_events(events, other));
}

TEST(StateDifference, FindsWhatTheNextProgramWouldNotice) {
  const std::pair<const char*, std::function<void(State&)>> cases[] = {
      {"work offset", [](State& s) { s.work_offset[3][2] = 0.001; }},
      {"shift (G52, G92)", [](State& s) { s.g92[0] = 1.0; }},
      {"shift (G52, G92)", [](State& s) { s.g92_stored[0] = 1.0; }},
      {"shift (G52, G92)", [](State& s) { s.g92_on = !s.g92_on; }},
      {"tool length", [](State& s) { s.tool_offset[2] = 1.0; }},
      {"offset", [](State& s) { s.offset[1] = 1.0; }},
      {"offset", [](State& s) { s.work_in_force[1] = 1.0; }},
      {"offset", [](State& s) { s.external[2] = 1.0; }},
      {"offset", [](State& s) { s.work_offset_on = !s.work_offset_on; }},
      {"modal state", [](State& s) { s.incremental = true; }},
      {"modal state", [](State& s) { s.feed_mm_s = 3.0; }}};
  const State original{};
  EXPECT_EQ(state_difference(original, original), "");
  for (const auto& [what, spoil] : cases) {
    State changed{};
    spoil(changed);
    EXPECT_EQ(state_difference(original, changed), what);
  }
  // Rounding of a correction that came and went is none.
  State rounded{};
  rounded.offset[2] = rounded.g92[2] = 0.9e-9;
  EXPECT_EQ(state_difference(original, rounded), "");
  rounded.g92[2] = 1.1e-9;
  EXPECT_EQ(state_difference(original, rounded), "shift (G52, G92)");
}

TEST(Modes, AreEveryModalWordThatAnInsertedLineMustLeaveAlone) {
  const std::function<void(State&)> spoils[] = {
      [](State& s) { s.active_offset = 2; },
      [](State& s) { s.rotation_in_force_deg = 1.0; },
      [](State& s) { s.unit_mm = 25.4; },
      [](State& s) { s.plane = interpret::Plane::zx; },
      [](State& s) { s.incremental = !s.incremental; },
      [](State& s) { s.centre_absolute = !s.centre_absolute; },
      [](State& s) { s.retract_to_initial = !s.retract_to_initial; },
      [](State& s) { s.motion = 99; },
      [](State& s) { s.feed_mode = FeedMode::per_revolution; },
      [](State& s) { s.feed_mm_s = 1.0; },
      [](State& s) { s.path_mode = PathMode::exact_stop; },
      [](State& s) { s.path_tolerance_mm = 0.1; },
      [](State& s) { s.override_off = !s.override_off; },
      [](State& s) { s.spindle_speed_rev_s = 1.0; },
      [](State& s) { s.spindle_direction = -1; },
      [](State& s) { s.surface_speed = !s.surface_speed; },
      [](State& s) { s.surface_speed_mm_s = 1.0; },
      [](State& s) { s.coolant = 2.0; },
      [](State& s) { s.selected_tool = 4; },
      [](State& s) { s.tool_in_spindle = 4; },
      [](State& s) { s.cutter_side = 1; },
      [](State& s) { s.diameter = !s.diameter; }};
  for (std::size_t i = 0; i < std::size(spoils); ++i) {
    State changed{};
    spoils[i](changed);
    EXPECT_FALSE(modes_of(State{}) == modes_of(changed)) << i;
    EXPECT_EQ(state_difference(State{}, changed), "modal state") << i;
  }
  // A correction itself changes positions and offsets: those are no modes.
  State corrected{};
  corrected.position[2] = corrected.offset[2] = 0.01;
  EXPECT_TRUE(modes_of(State{}) == modes_of(corrected));
}

// A plain line sets motion and feed alone; the short way must not lose them.
TEST(Modes, AreRenewedTheShortWayAfterAPlainLine) {
  State state{};
  Modes modes = modes_of(state);
  state.motion = 10;
  state.feed_mm_s = 5.0;
  renew(modes, state, true);
  EXPECT_TRUE(modes == modes_of(state));
  state.coolant = 2.0;
  renew(modes, state, true);
  EXPECT_FALSE(modes == modes_of(state));
  renew(modes, state, false);
  EXPECT_TRUE(modes == modes_of(state));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
