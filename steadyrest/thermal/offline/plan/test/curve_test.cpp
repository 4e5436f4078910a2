// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/curve.hpp>

namespace steadyrest::thermal::offline {
namespace {

TEST(Curve, IsWhatTheModelDoesStepByStep) {
  kernel::machine::ThermalAxis axis;
  axis.mode.resize(2);
  axis.mode[0].tau_s = 600.0;
  axis.mode[0].rest_tau_s = 900.0;
  axis.mode[0].polynomial_mm = {0.01};
  axis.mode[1].tau_s = 5000.0;
  axis.mode[1].polynomial_mm = {-0.004, 0.002};
  axis.ambient.push_back({.sensor = "room",
                          .tau_s = 3000.0,
                          .gain_mm_k = 0.002,
                          .reference_c = 20.0,
                          .state_c = 20.0});
  auto model = online::ThermalModel::make(axis);
  ASSERT_TRUE(model);
  online::Drive warm;
  warm.speed_rev_s = 30.0;
  warm.ambient_c[0] = 23.0;
  model->update(1000.0, warm);  // neither cold nor settled
  const auto cyclogram = parse_cyclogram(
      "[[transition]]\nminutes = 30\nspeed_rpm = 2400\n[[transition]]\nminutes = 20\nspeed_rpm = "
      "0\nload = \"standing\"\n[[transition]]\nminutes = 40\nspeed_rpm = -6000\n",
      "c.toml");
  ASSERT_TRUE(cyclogram) << kernel::outcome::text(cyclogram.error());
  EXPECT_DOUBLE_EQ(cyclogram->total_s(), 5400.0);
  const Curve curve = curve_of(*model, *cyclogram, {26.0});
  EXPECT_DOUBLE_EQ(curve.total_s(), 5400.0);
  double time_s = 0.0;
  for (const Transition& t : cyclogram->transition) {
    online::Drive drive = drive_of(t);
    drive.ambient_c[0] = 26.0;
    // The closed form against the model's own steps: both are exact, so they agree to rounding.
    for (double end = time_s + t.seconds; time_s < end - 0.5; time_s += 10.0) {
      ASSERT_NEAR(curve.at(time_s), model->displacement_mm(), 1e-14) << time_s;
      model->update(10.0, drive);
    }
  }
  EXPECT_NEAR(curve.at(5400.0), model->displacement_mm(), 1e-14);
  const auto most = curve.largest();
  // The largest is found from turning points; a scan must find nothing larger.
  for (double t = 0.0; t <= 5400.0; t += 1.0) {
    ASSERT_LE(std::abs(curve.at(t)), std::abs(most.displacement_mm) + 1e-15);
  }
  EXPECT_NEAR(curve.at(most.time_s), most.displacement_mm, 1e-12);
}

TEST(Curve, OfACyclogramThatDoesNotReadIsRefusedWithItsLine) {
  const auto refused = [](const char* text) {
    const auto read = parse_cyclogram(text, "c.toml");
    return read ? std::string{"accepted"} : kernel::outcome::text(read.error());
  };
  EXPECT_NE(refused("[[transition]]\nminutes = 3\n").find("c.toml:1"), std::string::npos);
  EXPECT_NE(refused("[[transition]]\nminutes = 3\nspeed_rpm = 5\nspeed = 4\n").find("c.toml:4"),
            std::string::npos);
  EXPECT_NE(refused("[[transition]]\nminutes = -3\nspeed_rpm = 5\n").find("c.toml:2"),
            std::string::npos);
  EXPECT_NE(
      refused("[[transition]]\nminutes = 3\nspeed_rpm = 5\nload = \"heavy\"\n").find("c.toml:4"),
      std::string::npos);
  EXPECT_NE(refused("[[transition]]\nminutes = 0\nspeed_rpm = 5\n").find("no duration"),
            std::string::npos);
  EXPECT_NE(refused("# nothing\n").find("[[transition]]"), std::string::npos);
  EXPECT_NE(refused("transition = 3\n").find("c.toml:1"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
