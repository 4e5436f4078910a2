// SPDX-License-Identifier: Apache-2.0
// A tool change between two cuts.
#include <cmath>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::signal::Motion;

TEST(ToolChange, TheCutAfterItIsCorrectedFromItsFirstCycle) {
  Stage stage({.program =
                   "G17 G90 G94 G71\nS3000 M3\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 F4000\nG0 Z10\nT2 "
                   "M6\nS3000 M3\nG0 Z0\nG3 X10 Y0 I-10 J0 TURN=3 F4000\nM30\n"});
  constexpr std::size_t kCycles = 4500;
  stage.run(kCycles);
  const auto& log = stage.log();
  std::size_t begins = 0;
  while (begins < log.size() && log[begins].frame.motion != Motion::tool_change) {
    ++begins;
  }
  std::size_t ends = begins;
  while (ends < log.size() && log[ends].frame.motion == Motion::tool_change) {
    ++ends;
  }
  ASSERT_LT(ends, 3500U);
  ASSERT_GT(ends - begins, 900U) << "4 s";
  std::size_t cut = ends;
  while (cut < log.size() && log[cut].frame.motion != Motion::feed) {
    ++cut;
  }
  ASSERT_LT(cut + 100, log.size());
  EXPECT_LT(log[cut].feed_ratio(), 0.6) << "the word is there before the cut begins";
  for (std::size_t i = cut; i < kCycles; ++i) {
    const auto& status = log[i].status;
    ASSERT_LE(std::abs(status.contour_error_mm), 1.1 * status.contour_limit_mm)
        << "88 µm without the layer, 5 more for the offset against heat";
  }
}

}  // namespace
}  // namespace steadyrest::scenarios
