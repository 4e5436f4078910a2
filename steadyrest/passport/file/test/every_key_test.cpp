// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/test/full_machine.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// Every key of full_machine.hpp must reach its field of the machine.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Coding;
using kernel::machine::ContourStrategy;
using kernel::machine::Control;
using kernel::machine::Dialect;
using kernel::machine::Machine;
using kernel::machine::Mode;
using kernel::machine::OverrideTable;
using kernel::machine::PortKind;
using kernel::machine::Simulation;
using test::full;

constexpr double kPi = std::numbers::pi;

// The full machine gives each key a different value (1001, 1002, …), so two keys that were swapped
// show. Values are in the inner units: ms to s, mm/min to mm/s, ° to rad.
TEST(EveryKey, TopAndControl) {
  const Machine m = full();
  EXPECT_EQ(m.name, "Full");
  EXPECT_EQ(m.port, PortKind::sim);
  EXPECT_EQ(m.mode, Mode::advise);
  const Control& c = m.control;
  EXPECT_EQ(c.dialect, Dialect::linuxcnc);
  EXPECT_EQ(c.units, kernel::machine::ProgramUnit::inch);
  EXPECT_DOUBLE_EQ(c.interpolator_period_s, 0.006);
  EXPECT_DOUBLE_EQ(c.servo_period_s, 0.003);
  EXPECT_DOUBLE_EQ(c.max_path_acceleration_mm_s2, 1001);
  EXPECT_DOUBLE_EQ(c.max_path_jerk_mm_s3, 1002);
  EXPECT_DOUBLE_EQ(c.max_feed_mm_s, 1003);
  EXPECT_DOUBLE_EQ(c.rapid_mm_s, 1004);
  EXPECT_EQ(c.look_ahead_blocks, 105U);
  EXPECT_DOUBLE_EQ(c.corner_tolerance_mm, 0.06);
  EXPECT_DOUBLE_EQ(c.junction_deviation_mm, 0.07);
  EXPECT_DOUBLE_EQ(c.tool_change_s, 8);
}

TEST(EveryKey, PathPlanner) {
  const Control c = full().control;
  EXPECT_DOUBLE_EQ(c.centripetal_share, 0.51);
  EXPECT_DOUBLE_EQ(c.blend_share, 0.22);
  EXPECT_DOUBLE_EQ(c.blend_gap_cycles, 3);
  EXPECT_DOUBLE_EQ(c.min_block_cycles, 4);
  EXPECT_DOUBLE_EQ(c.block_time_s, 0.0055);
  EXPECT_DOUBLE_EQ(c.exact_stop_mm, 0.0095);
  EXPECT_EQ(c.acceleration_mode, kernel::machine::AccelerationMode::brisk);
  EXPECT_EQ(c.planner, kernel::machine::LinuxCncPlanner::s_curve);
  EXPECT_DOUBLE_EQ(c.merge_share, 0.55);
  EXPECT_DOUBLE_EQ(c.junction_share, 0.56);
  EXPECT_DOUBLE_EQ(c.corner_acceleration_share, 0.57);
  EXPECT_TRUE(c.clips_programmed_feed);
  EXPECT_TRUE(c.stop_between_rapid_and_feed);
}

TEST(EveryKey, LinearAxis) {
  const Axis x = full().axes[0];
  EXPECT_DOUBLE_EQ(x.servo_gain_1_s, 11);
  EXPECT_DOUBLE_EQ(x.feed_forward, 0.12);
  EXPECT_DOUBLE_EQ(x.velocity_lag_s, 0.013);
  EXPECT_DOUBLE_EQ(x.max_speed_au_s, 14);
  EXPECT_DOUBLE_EQ(x.max_acceleration_au_s2, 15);
  EXPECT_DOUBLE_EQ(x.max_jerk_au_s3, 16);
  EXPECT_DOUBLE_EQ(x.drive_acceleration_au_s2, 17);
  EXPECT_DOUBLE_EQ(x.backlash_au, 0.018);
  EXPECT_DOUBLE_EQ(x.min_au, -19);
  EXPECT_DOUBLE_EQ(x.max_au, 20);
  EXPECT_DOUBLE_EQ(x.encoder.count_au, 0.021);
  EXPECT_DOUBLE_EQ(x.encoder.line_error_au, 0.022);
  EXPECT_DOUBLE_EQ(x.encoder.line_period_au, 0.023);
  EXPECT_DOUBLE_EQ(x.encoder.clock_s, 230e-9);
  ASSERT_EQ(x.encoder.phase_error_au.size(), 4U);
  EXPECT_DOUBLE_EQ(x.encoder.phase_error_au[1], -0.00025);
  EXPECT_EQ(x.encoder.line_table_first, -7);
  EXPECT_FALSE(x.encoder.line_table_periodic);
  ASSERT_EQ(x.encoder.line_table_au.size(), 3U);
  EXPECT_DOUBLE_EQ(x.encoder.line_table_au[2], -0.0205);
  EXPECT_DOUBLE_EQ(x.friction.coulomb_au_s2, 24);
  EXPECT_DOUBLE_EQ(x.friction.breakaway_au_s2, 25);
  EXPECT_DOUBLE_EQ(x.friction.stribeck_au_s, 26);
  EXPECT_DOUBLE_EQ(x.friction.viscous_1_s, 27);
  // The second axis gives its gain as 6 (m/min)/mm: 6·1000/60 = 100 1/s.
  EXPECT_DOUBLE_EQ(full().axes[1].servo_gain_1_s, 100);
}

// All values of the rotary axis are simple fractions of 180°, hence of π.
TEST(EveryKey, RotaryAxis) {
  const Axis b = full().axes[3];
  ASSERT_EQ(b.name, "B");
  EXPECT_TRUE(b.rotary);
  EXPECT_DOUBLE_EQ(b.max_speed_au_s, kPi);
  EXPECT_DOUBLE_EQ(b.max_acceleration_au_s2, 2 * kPi);
  EXPECT_DOUBLE_EQ(b.max_jerk_au_s3, 3 * kPi);
  EXPECT_DOUBLE_EQ(b.drive_acceleration_au_s2, 4 * kPi);
  EXPECT_DOUBLE_EQ(b.backlash_au, kPi / 200);
  EXPECT_DOUBLE_EQ(b.min_au, -kPi / 2);
  EXPECT_DOUBLE_EQ(b.max_au, kPi / 4);
  EXPECT_DOUBLE_EQ(b.encoder.count_au, kPi / 1000);
  EXPECT_DOUBLE_EQ(b.encoder.line_error_au, kPi / 500);
  EXPECT_DOUBLE_EQ(b.encoder.line_period_au, kPi / 100);
  EXPECT_EQ(b.encoder.clock_s, 0.0);
  ASSERT_EQ(b.encoder.phase_error_au.size(), 4U);
  EXPECT_DOUBLE_EQ(b.encoder.phase_error_au[3], -kPi / 2000.0);
  EXPECT_TRUE(b.encoder.line_table_periodic);
  ASSERT_EQ(b.encoder.line_table_au.size(), 4U);
  EXPECT_DOUBLE_EQ(b.encoder.line_table_au[0], kPi / 10000.0);
  EXPECT_DOUBLE_EQ(b.friction.coulomb_au_s2, kPi / 10);
  EXPECT_DOUBLE_EQ(b.friction.breakaway_au_s2, kPi / 5);
  EXPECT_DOUBLE_EQ(b.friction.stribeck_au_s, 0.3 * kPi);
}

// Codes 7, 8, 9 are nobody's default, so they must come from the file.
TEST(EveryKey, Overrides) {
  const Machine m = full();
  const OverrideTable& feed = m.feed_override;
  EXPECT_EQ(feed.coding, Coding::binary);
  EXPECT_EQ(feed.ratio, (std::vector{0.0, 0.5, 1.0}));
  EXPECT_EQ(feed.code, (std::vector{7U, 8U, 9U}));
  EXPECT_DOUBLE_EQ(feed.scan_period_s, 0.031);
  EXPECT_DOUBLE_EQ(feed.dead_time_s, 0.032);
  EXPECT_FALSE(feed.latched_word);
  EXPECT_TRUE(feed.layer_may_exceed_panel);
  EXPECT_DOUBLE_EQ(feed.max_ratio, 1.33);
  EXPECT_EQ(m.rapid_override.code, (std::vector{0U, 1U, 2U, 3U, 4U}));
  EXPECT_DOUBLE_EQ(m.rapid_override.ratio[3], 0.6);
  EXPECT_EQ(m.spindle_override.coding, Coding::gray);
  EXPECT_EQ(m.spindle_override.code, (std::vector{1U, 3U}));
}

// The rest of the sections, one value each.
TEST(EveryKey, SpindleContourEnvelopeSimulation) {
  const Machine m = full();
  EXPECT_DOUBLE_EQ(m.spindle.max_rev_s, 41);
  EXPECT_DOUBLE_EQ(m.spindle.min_rev_s, 1);
  EXPECT_DOUBLE_EQ(m.spindle.acceleration_rev_s2, 2);
  EXPECT_DOUBLE_EQ(m.spindle.inertia_kg_m2, 43);
  EXPECT_DOUBLE_EQ(m.spindle.rated_power_w, 44000);
  EXPECT_DOUBLE_EQ(m.spindle.max_torque_n_m, 45);
  EXPECT_DOUBLE_EQ(m.spindle.rated_torque_n_m, 42);
  EXPECT_DOUBLE_EQ(m.spindle.speed_tolerance_ratio, 0.47);
  EXPECT_FALSE(m.contour.enabled);
  EXPECT_EQ(m.contour.strategy, ContourStrategy::combined);
  EXPECT_DOUBLE_EQ(m.contour.limit_mm, 0.051);
  EXPECT_DOUBLE_EQ(m.contour.target_mm, 0.050);
  EXPECT_DOUBLE_EQ(m.contour.min_ratio, 0.52);
  EXPECT_DOUBLE_EQ(m.contour.max_ratio, 0.53);
  EXPECT_DOUBLE_EQ(m.contour.weight_contour, 54);
  EXPECT_DOUBLE_EQ(m.contour.weight_feed, 55);
  EXPECT_DOUBLE_EQ(m.contour.margin, 0.56);
  EXPECT_DOUBLE_EQ(m.envelope.min_feed_ratio, 0.61);
  EXPECT_DOUBLE_EQ(m.envelope.max_feed_ratio, 1.62);
  EXPECT_DOUBLE_EQ(m.envelope.feed_fall_1_s, 0.63);
  EXPECT_DOUBLE_EQ(m.envelope.feed_rise_1_s, 0.64);
  EXPECT_DOUBLE_EQ(m.envelope.min_spindle_ratio, 0.65);
  EXPECT_DOUBLE_EQ(m.envelope.max_spindle_ratio, 1.66);
  EXPECT_DOUBLE_EQ(m.envelope.spindle_slew_1_s, 0.67);
  EXPECT_DOUBLE_EQ(m.envelope.max_offset_mm, 0.068);
  EXPECT_DOUBLE_EQ(m.envelope.offset_slew_mm_s, 0.069);
  EXPECT_DOUBLE_EQ(m.envelope.max_path_offset_mm, 0.69);
  EXPECT_DOUBLE_EQ(m.envelope.path_offset_slew_mm_s, 69.0);
  EXPECT_DOUBLE_EQ(m.envelope.stale_after_s, 0.070);
  EXPECT_DOUBLE_EQ(m.envelope.late_hold_s, 0.700);
  EXPECT_EQ(m.simulation.seed, 71U);
  EXPECT_DOUBLE_EQ(m.simulation.position_noise_mm, 0.072);
}

/// Nothing here would read a schema key that the full machine does not set.
template <class S>
void expect_all_tried(std::span<const Key<S>> keys) {
  for (const Key<S>& key : keys) {
    if (key.name == "amplitude_percent") {
      continue;  // excludes amplitude_rpm; EveryKey.Chatter tries it
    }
    const std::string line = "\n" + std::string(key.name) + " = ";
    EXPECT_TRUE(("\n" + std::string(test::kFullMachine)).find(line) != std::string::npos)
        << key.name << " is not tested here";
  }
}

TEST(EveryKey, HeatOfTheSimulatedMachine) {
  const Simulation s = full().simulation;
  EXPECT_EQ(s.thermal_tau_error_ratio, (std::vector{0.73, -0.74}));
  EXPECT_EQ(s.thermal_gain_error_ratio, (std::vector{0.75}));
  EXPECT_DOUBLE_EQ(s.room_c, 26);
  EXPECT_DOUBLE_EQ(s.room_swing_k, 7.7);
  EXPECT_DOUBLE_EQ(s.room_noise_k, 0.78);
  EXPECT_DOUBLE_EQ(s.room_start_s, 7.9 * 3600);
  EXPECT_DOUBLE_EQ(s.sensor_noise_k, 0.8);
  EXPECT_DOUBLE_EQ(s.probe_noise_mm, 0.081);
}

TEST(EveryKey, IsTriedHere) {
  expect_all_tried(top_keys());
  expect_all_tried(control_keys());
  expect_all_tried(axis_keys());
  expect_all_tried(encoder_keys());
  expect_all_tried(friction_keys());
  expect_all_tried(override_keys());
  expect_all_tried(spindle_keys());
  expect_all_tried(contour_keys());
  expect_all_tried(chatter_keys());
  expect_all_tried(envelope_keys());
  expect_all_tried(simulation_keys());
}

}  // namespace
}  // namespace steadyrest::passport
