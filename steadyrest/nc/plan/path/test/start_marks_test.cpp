// SPDX-License-Identifier: Apache-2.0
// Which moves follow from where a program starts.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/start_marks.hpp>

namespace steadyrest::nc::plan {
namespace {

using testing::Each;
using testing::ElementsAre;

class Kept final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override { from_start.push_back(move.from_start); }
  void on_event(const interpret::Event& /*event*/) override {}
  std::vector<bool> from_start;
};

std::vector<bool> marks_of(const std::string& text) {
  interpret::Config config;
  config.dialect = read::Dialect::linuxcnc;
  MovedAxes moved;
  EXPECT_TRUE(interpret::run_text(text, config, moved).has_value());
  MoveMarks elsewhere;
  EXPECT_TRUE(interpret::run_text(text, started_elsewhere(config, moved), elsewhere).has_value());
  Kept kept;
  StartMarks marks(elsewhere, kept);
  const auto report = interpret::run_text(text, config, marks);
  EXPECT_TRUE(report.has_value() && report->refused.empty()) << text;
  return kept.from_start;
}

TEST(StartMarks, AbsoluteMovesAreMarkedUntilEveryAxisWasGiven) {
  // X and Y leave Z where it was; the fourth begins where it is known.
  const auto kept = marks_of("G21 G90 F100\nG0 X1 Y2\nG0 Z3\nG1 X4\nY5 Z6\nG2 X0 Y5 I-2 J0\nM2\n");
  EXPECT_THAT(kept, ElementsAre(true, true, false, false, false));
}

// B is never given: it stays where it is. A is, and then counts from there on.
TEST(StartMarks, AxesThatStandDoNotMatterThoseThatMoveDo) {
  EXPECT_THAT(marks_of("G21 G90 F100\nG0 X1 Y2 Z3\nG1 X4\nM2\n"), ElementsAre(true, false));
  EXPECT_THAT(marks_of("G21 G90 F100\nG0 X1 Y2 Z3\nG1 X4\nG0 A9 B0 C0\nX1\nM2\n"),
              ElementsAre(true, true, true, false));
}

TEST(StartMarks, RelativeMovesAreMarkedToTheEnd) {
  EXPECT_THAT(marks_of("G21 G91 F100\nG1 X1 Y1 Z1\nX2\nG3 X0 Y4 R2\nM2\n"), Each(true));
}

TEST(StartMarks, RelativeMovesFromAKnownPlaceAreNot) {
  const auto kept = marks_of("G21 G90 F100\nG0 X0 Y0 Z0\nG1 X9\nG91\nY3\nX3\nM2\n");
  EXPECT_THAT(kept, ElementsAre(true, false, false, false));
}

// An offset set from the present position brings the start into absolute moves.
TEST(StartMarks, AnOffsetTakenFromTheStartMarksWhatFollows) {
  EXPECT_THAT(marks_of("G21 G90 F100\nG92 X0 Y0 Z0\nG1 X9 Y1 Z1\nX0\nM2\n"), Each(true));
}

TEST(StartMarks, WhereAProbeTouchedIsNotKnown) {
  const auto kept =
      marks_of("G21 G90 F100\nG0 X0 Y0 Z0\nG1 Z2\nG38.2 Z-5\nG91 G0 Z1\nG90 G0 Z20\nX5\nM2\n");
  // The retract begins and ends, and the move after it begins, where it depends on the touch.
  EXPECT_THAT(kept, ElementsAre(true, false, false, true, true, false));
}

// An arc by its centre from elsewhere is refused: nothing behind it is known to be the same.
TEST(StartMarks, WhatTheRunFromElsewhereDoesNotReachIsMarked) {
  const auto kept = marks_of("G21 G90 F100\nG2 X10 Y0 I5 J0\nG1 X20 Y0 Z0\nX30\nM2\n");
  EXPECT_THAT(kept, Each(true));
}

}  // namespace
}  // namespace steadyrest::nc::plan
