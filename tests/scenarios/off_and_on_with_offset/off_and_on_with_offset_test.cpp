// SPDX-License-Identifier: Apache-2.0
// The machine is switched off for eight seconds with an offset in force. When it comes back its
// clock and its cycles begin at zero, and the offset may be in its position (LinuxCNC 2.9 does so).
#include <cmath>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

constexpr std::size_t kOff = 1000;
constexpr std::size_t kOn = 3000;

TEST(OffAndOnWithOffset, BeginsAtZeroAndComesBackBySlew) {
  Stage stage;
  stage.link = [](std::size_t cycle) {
    return cycle >= kOff && cycle < kOn ? Stage::Link::no_read : Stage::Link::good;
  };
  double zero_s = 0.0;
  std::uint64_t zero = 0;
  stage.show = [&](std::size_t cycle, kernel::signal::Frame& frame) {
    if (cycle == kOn) {
      zero_s = frame.time_s;
      zero = frame.cycle;
    }
    if (cycle >= kOn) {
      frame.time_s -= zero_s;
      frame.cycle -= zero;
      frame.axis[2].command_mm -= 0.005;
      frame.axis[2].actual_mm -= 0.005;
    }
  };
  stage.run(4000);
  const auto& log = stage.log();
  EXPECT_NE(log[kOff - 1].written->offset_mm[2], 0.0);
  EXPECT_FALSE(log[kOn].written) << "how long it was off is not known yet";
  std::size_t first = kOn;
  while (!log[first].written) {
    ++first;
  }
  EXPECT_LE(first, kOn + 3);
  EXPECT_FALSE(log[first].masks());
  EXPECT_LT(std::abs(log[first].written->offset_mm[2]), 0.0005);
  EXPECT_NE(log[3999].written->offset_mm[2], 0.0);
  EXPECT_LT(log[3999].feed_ratio(), 0.6) << "it corrects again";
}

}  // namespace
}  // namespace steadyrest::scenarios
