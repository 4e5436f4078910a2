// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/encoders.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Axis;
using test::PageDesk;
using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;

/// Of 1 µm counts, with every line of −5 … 5 mm learnt.
Axis calibrated() {
  Axis axis;
  axis.min_au = -5.0;
  axis.max_au = 5.0;
  axis.encoder.count_au = 0.001;
  axis.encoder.line_error_au = 0.0002;
  axis.encoder.phase_error_au = {5e-5, -5e-5, 1e-5, -1e-5};
  axis.encoder.line_table_first = -5100;
  for (int line = -5100; line <= 5100; ++line) {
    axis.encoder.line_table_au.push_back((line < 0 ? 2e-5 : 4e-5) + (line % 2 == 0 ? 1e-6 : -1e-6));
  }
  return axis;
}

TEST(EncodersOnPage, AreThoseOfTheMachineFile) {
  PageDesk desk;
  desk.log_in();
  const Json axes = desk.json("GET", "/api/v1/motion")["motion"]["axes"];
  ASSERT_THAT(axes, SizeIs(3));
  EXPECT_EQ(axes[0]["name"], "X");
  EXPECT_NEAR(axes[0]["encoder"]["count_um"], 0.1, 1e-12);
  EXPECT_NEAR(axes[0]["encoder"]["line_period_um"], 20.0, 1e-12);
  EXPECT_EQ(axes[0]["encoder"]["clock_ns"], 100.0);
  EXPECT_EQ(axes[0]["calibration"], nullptr);
  EXPECT_EQ(axes[0]["estimator"]["input"], "edges");
  EXPECT_EQ(axes[0]["estimator"]["lag_ms"], 0.0);
  EXPECT_NEAR(axes[0]["estimator"]["line_error_um"], 0.1, 1e-12);
}

TEST(EncodersOnPage, ShowACalibrationWithItsCurveAndWhatItLeaves) {
  const Axis axis = calibrated();
  const Json shown = encoder_json(axis, 0.001);
  const Json& calibration = shown["calibration"];
  EXPECT_NEAR(calibration["phase_error_um"][0], 0.05, 1e-12);
  EXPECT_EQ(calibration["lines"], 10'201);
  EXPECT_EQ(calibration["lines_learnt"], 10'201);
  EXPECT_EQ(calibration["applied"], true);
  const Json& curve = calibration["curve"];
  ASSERT_THAT(curve["at_mm"], SizeIs(400));
  for (std::size_t i = 0; i < 400; ++i) {
    const double at = curve["at_mm"][i];
    EXPECT_LE(std::abs(at), 5.1) << i;
    // The lowest and highest of a stretch: the table's level and the phases about it.
    if (std::abs(at) > 0.1) {
      EXPECT_NEAR(curve["low_um"][i], (at < 0.0 ? 0.02 : 0.04) - 0.05, 2e-3) << at;
      EXPECT_NEAR(curve["high_um"][i], (at < 0.0 ? 0.02 : 0.04) + 0.05, 2e-3) << at;
    }
  }
  // What a table leaves, 4·√(σ² + (0.004 counts)²), not the 0.2 µm without one.
  EXPECT_GT(shown["estimator"]["line_error_um"], 0.016);
  EXPECT_LT(shown["estimator"]["line_error_um"], 0.05);
}

TEST(EncodersOnPage, SayWhereNothingBoundsTheEstimate) {
  Axis axis;
  axis.encoder.count_au = 0.001;
  axis.encoder.line_error_au = 0.002;  // a line may be its neighbour
  axis.encoder.clock_s = 0.0;
  const Json shown = encoder_json(axis, 0.001);
  EXPECT_EQ(shown["estimator"]["bounded"], false);
  EXPECT_EQ(shown["estimator"]["line_error_um"], nullptr);
  EXPECT_EQ(shown["estimator"]["input"], "counts");
  EXPECT_EQ(shown["encoder"]["clock_ns"], nullptr);
  axis.encoder.count_au = 0.0;
  EXPECT_EQ(encoder_json(axis, 0.001)["estimator"], nullptr);
  EXPECT_EQ(encoder_json(axis, 0.001)["encoder"]["ideal"], true);
}

TEST(EncodersOnPage, GiveRotaryAxesInDegrees) {
  Axis axis;
  axis.name = "C";
  axis.rotary = true;
  axis.encoder.count_au = 0.001;
  axis.encoder.phase_error_au = {1e-4, -1e-4, 1e-4, -1e-4};
  const Json shown = encoder_json(axis, 0.001);
  EXPECT_NEAR(shown["encoder"]["count_deg"], 0.0572957795, 1e-9);
  EXPECT_NEAR(shown["calibration"]["phase_error_deg"][0], 0.00572957795, 1e-9);
  EXPECT_EQ(shown["calibration"]["curve"], nullptr);
  EXPECT_EQ(shown["calibration"]["applied"], true);
}

}  // namespace
}  // namespace steadyrest::apps::live_page
