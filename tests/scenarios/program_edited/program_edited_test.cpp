// SPDX-License-Identifier: Apache-2.0
// The program is edited while it runs: the path that the layer is shown changes its storage, its
// length and its shape, and no longer fits what the machine cuts.
#include <vector>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::signal::Frame;
using kernel::signal::PathSegment;

constexpr std::size_t kEdited = 1000;

TEST(ProgramEdited, ThePathOfAnotherProgramDoesNotGetACommandPastTheEnvelope) {
  Stage stage({.max_path_offset_mm = 0.5});
  std::vector<PathSegment> edited;
  stage.show = [&edited](std::size_t cycle, Frame& frame) {
    if (cycle == kEdited) {
      edited.assign(frame.path.begin(), frame.path.end());
      for (PathSegment& segment : edited) {
        segment.radius_mm *= 0.5;  // the arc ends beside its own end point
        segment.radius_end_mm *= 0.5;
        segment.length_mm *= 0.5;
      }
      edited.insert(edited.begin(), PathSegment{.end_mm = {5.0, 5.0, 5.0}, .length_mm = 8.66});
    }
    if (cycle >= kEdited) {
      frame.path = edited;
    }
  };
  stage.run(2000);
  EXPECT_NEAR(stage.log()[1999].frame.axis[2].command_mm, stage.log()[999].frame.axis[2].command_mm,
              0.1);
}

TEST(ProgramEdited, TheSameProgramInAnotherPlaceIsCorrectedOn) {
  Stage stage;
  std::vector<PathSegment> copies[2];
  stage.show = [&copies](std::size_t cycle, Frame& frame) {
    if (cycle >= kEdited && cycle % 100 == 0) {  // reloaded again and again
      auto& copy = copies[cycle / 100 % 2];
      copy.assign(frame.path.begin(), frame.path.end());
    }
    if (cycle >= kEdited) {
      frame.path = copies[cycle / 100 % 2];
    }
  };
  stage.run(2000);
  for (std::size_t i = kEdited; i < 2000; ++i) {
    ASSERT_LT(stage.log()[i].feed_ratio(), 0.6);
    ASSERT_TRUE(stage.log()[i].status.error_known);
  }
}

}  // namespace
}  // namespace steadyrest::scenarios
