// SPDX-License-Identifier: Apache-2.0
// Emergency stop in the cut: drives off, the axes coast away from their commands, which then follow
// them; the spindle runs down.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::signal::Frame;

constexpr std::size_t kStop = 1000;

TEST(EmergencyStop, HandsTheFeedBackAndAddsNothingToTheAxes) {
  Stage stage({.max_path_offset_mm = 0.5});
  Frame since;
  stage.show = [&since](std::size_t cycle, Frame& frame) {
    if (cycle == kStop) {
      since = frame;
    }
    if (cycle >= kStop) {
      const double passed_s = 0.004 * static_cast<double>(cycle - kStop);
      stand(frame, since);
      for (std::size_t i = 0; i < 2; ++i) {
        frame.axis[i].actual_mm += std::min(3.0, 60.0 * passed_s);
        frame.axis[i].command_mm = frame.axis[i].actual_mm;
      }
      frame.spindle_actual_rev_s *= std::max(0.0, 1.0 - passed_s);
      frame.spindle_command_rev_s = 0.0;
    }
  };
  stage.run(2000);
  const auto& log = stage.log();
  EXPECT_GT(std::abs(log[kStop - 1].written->path_offset_mm[0]), 0.01);
  for (std::size_t i = kStop + 60; i < 2000; ++i) {
    ASSERT_TRUE(log[i].written);
    for (const double offset_mm : log[i].written->path_offset_mm) {
      ASSERT_LE(std::abs(offset_mm), 0.0011) << "half of the backlash, which keeps the table still";
    }
  }
  for (std::size_t i = kStop + 500; i < 2000; ++i) {
    ASSERT_FALSE(log[i].masks());
  }
}

}  // namespace
}  // namespace steadyrest::scenarios
