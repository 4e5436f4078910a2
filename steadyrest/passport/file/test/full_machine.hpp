// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/machine_file.hpp>

/// A machine file with every key of the schema, each at a different value.
namespace steadyrest::passport::test {

inline constexpr std::string_view kFullMachine = R"(name = "Full"
port = "sim"
mode = "advise"
[control]
dialect = "linuxcnc"
units = "inch"
interpolator_period_ms = 6
servo_period_ms = 3
max_path_acceleration_mm_s2 = 1001
max_path_jerk_mm_s3 = 1002
max_feed_mm_min = 60180
rapid_mm_min = 60240
look_ahead_blocks = 105
corner_tolerance_mm = 0.06
junction_deviation_mm = 0.07
tool_change_s = 8
centripetal_share = 0.51
blend_share = 0.22
blend_gap_cycles = 3
min_block_cycles = 4
block_time_ms = 5.5
exact_stop_um = 9.5
acceleration_mode = "brisk"
planner = "s_curve"
merge_share = 0.55
junction_share = 0.56
corner_acceleration_share = 0.57
clips_programmed_feed = true
stop_between_rapid_and_feed = true
[program]
startup = "G20 G64 P0.001"
remapped = "M6 G88.8 T"
wrapped_axes = "A"
indexer_axes = "BC"
tool_change_quill_up = true
tool_change_at_g30 = true
tool_change_with_spindle_on = true
tool_change_position_mm = [1.25, -2.5, 31]
tool_change_rotary_deg = [90, 0, -180]
tool_change_keeps_offset = true
fanuc_subprograms = false
g92_persists = false
arc_tolerance_mm = 0.011
inch_arc_tolerance_mm = 0.012
subprogram_folders = "subs:/macros"
[[axis]]
name = "X"
servo_gain_1_s = 11
feed_forward = 0.12
velocity_lag_ms = 13
max_feed_mm_min = 840
max_acceleration_mm_s2 = 15
max_jerk_mm_s3 = 16
drive_acceleration_mm_s2 = 17
backlash_um = 18
min_mm = -19
max_mm = 20
[axis.encoder]
count_um = 21
line_error_um = 22
line_period_um = 23
phase_error_um = [0.5, -0.25, -0.5, 0.25]
line_table_first = -7
line_table_um = [1.5, 0, -20.5]
clock_ns = 230
[axis.friction]
coulomb_mm_s2 = 24
breakaway_mm_s2 = 25
stribeck_mm_s = 26
viscous_1_s = 27
[[axis]]
name = "Y"
servo_gain_m_min_mm = 6
max_feed_mm_min = 60
max_acceleration_mm_s2 = 1
[[axis]]
name = "B"
servo_gain_1_s = 11
max_speed_deg_s = 180
max_acceleration_deg_s2 = 360
max_jerk_deg_s3 = 540
drive_acceleration_deg_s2 = 720
backlash_deg = 0.9
min_deg = -90
max_deg = 45
[axis.encoder]
count_deg = 0.18
line_error_deg = 0.36
line_period_deg = 1.8
phase_error_deg = [0.09, 0, 0, -0.09]
line_table_periodic = true
line_table_deg = [0.018, 0, -0.018, 0]
clock_ns = 0
[axis.friction]
coulomb_deg_s2 = 18
breakaway_deg_s2 = 36
stribeck_deg_s = 54
[override.feed]
coding = "binary"
percent = [0, 50, 100]
codes = [7, 8, 9]
scan_period_ms = 31
dead_time_ms = 32
latched_word = false
layer_may_exceed_panel = true
max_percent = 133
[override.rapid]
coding = "binary"
binary_max_percent = 80
binary_step_percent = 20
[override.spindle]
coding = "gray"
percent = [60, 100]
[spindle]
max_rpm = 2460
min_rpm = 60
acceleration_rpm_s = 120
inertia_kg_m2 = 43
rated_power_kw = 44
max_torque_n_m = 45
rated_torque_n_m = 42
speed_tolerance_percent = 47
[contour]
enabled = false
strategy = "combined"
limit_um = 51
target_um = 50
min_percent = 52
max_percent = 53
weight_contour = 54
weight_feed = 55
margin_percent = 56
[chatter]
enabled = true
law = "random"
amplitude_rpm = 180
period_s = 0.57
mean_percent = 58
feed_per_tooth_min_percent = 59
feed_per_tooth_max_percent = 160
m_code_on = 138
m_code_off = 139
seed = 73
[envelope]
min_feed_percent = 61
max_feed_percent = 162
feed_fall_percent_s = 63
feed_rise_percent_s = 64
min_spindle_percent = 65
max_spindle_percent = 166
spindle_slew_percent_s = 67
max_offset_um = 68
offset_slew_um_s = 69
max_path_offset_um = 690
path_offset_slew_um_s = 69000
stale_after_ms = 70
late_hold_ms = 700
[simulation]
seed = 71
position_noise_um = 72
thermal_tau_error_percent = [73, -74]
thermal_gain_error_percent = [75]
room_c = 26
room_swing_k = 7.7
room_noise_k = 0.78
room_start_h = 7.9
sensor_noise_k = 0.80
probe_noise_um = 81
[thermal]
[[thermal.axis]]
name = "Z"
[[thermal.axis.mode]]
tau_min = 15
polynomial_um = [1]
[[thermal.axis.ambient]]
sensor = "room"
gain_um_k = 2
)";

inline kernel::machine::Machine full() {
  const auto machine = parse(kFullMachine, "full.toml");
  EXPECT_TRUE(machine) << kernel::outcome::text(machine.error());
  return machine.value_or(kernel::machine::Machine{});
}

}  // namespace steadyrest::passport::test
