// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>

/// The machine's passport as values: what the machine file (TOML) says, converted once to the inner
/// units.
///
/// The same values drive the simulated machine and the layer on the real one. Every field has a
/// working default; the schema (`schema.cpp`) gives each key its unit and its range.
namespace steadyrest::kernel::machine {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

enum class PortKind : std::uint8_t { sim, linuxcnc, modbus, opcua, replay };
enum class Dialect : std::uint8_t { linuxcnc, fanuc, sinumerik };
enum class Coding : std::uint8_t { gray, binary };

/// Friction of one axis as an acceleration (force over moved mass), Stribeck curve:
/// f(v) = sign(v)·(coulomb + (breakaway − coulomb)·exp(−(v/stribeck)²)) + viscous·v.
struct Friction {
  double coulomb_mm_s2 = 0.0;
  double breakaway_mm_s2 = 0.0;
  double stribeck_mm_s = 1.0;
  double viscous_1_s = 0.0;
};

struct Encoder {
  double count_mm = 0.001;        ///< length of one count after ×4 decoding; 0 = ideal
  double line_error_mm = 0.0;     ///< amplitude of the error that repeats with each line
  double line_period_mm = 0.004;  ///< length of one line
  // The calibration, motion::online::LineTable: line k stands at k·count_mm + phase_error_mm[k mod
  // 4] + line_table_mm[k − line_table_first].
  std::vector<double> phase_error_mm;  ///< none or 4, their sum 0
  std::int64_t line_table_first = 0;   ///< line of the first entry
  bool line_table_periodic = false;    ///< the table is one revolution
  std::vector<double> line_table_mm;   ///< 0 = line not known
  double clock_s = 1e-7;  ///< period of the edges' time stamps; 0 = the counter gives none
};

struct Axis {
  std::string name = "X";  ///< X Y Z A B C U V W
  bool rotary = false;
  bool present = true;  ///< false: stands in for a missing X, Y or Z (a lathe's Y) so that the
                        ///< first three are X, Y, Z on every machine; its travel is 0…0
  double servo_gain_1_s = 50.0;   ///< position loop gain k
  double feed_forward = 0.0;      ///< weight a of the velocity feed-forward, 0…1
  double velocity_lag_s = 0.0;    ///< first-order lag of the closed velocity loop
  double max_speed_mm_s = 200.0;  ///< rad/s for rotary axes, likewise below
  double max_acceleration_mm_s2 = 2000.0;
  double max_jerk_mm_s3 = kUnlimited;
  double drive_acceleration_mm_s2 =
      kUnlimited;  ///< what the drive can do at its current limit; the servo saturates there
  double backlash_mm = 0.0;
  double min_mm = -1e6;
  double max_mm = 1e6;
  Friction friction;
  Encoder encoder;
};

/// An override switch as machine data: step i has ratio[i] and code[i].
struct OverrideTable {
  Coding coding = Coding::gray;
  std::vector<double> ratio;        ///< by step, not decreasing; 1.0 = 100 %
  std::vector<std::uint32_t> code;  ///< as long as `ratio`; distinct
  double scan_period_s = 0.01;      ///< the PLC looks at the word this often
  double dead_time_s = 0.0;         ///< from the scan until the interpolator acts
  bool latched_word = true;  ///< the word takes effect as a whole; else neighbours are walked
  bool layer_may_exceed_panel = false;
  double max_ratio = 2.0;  ///< the control clips here
};

/// How the control plans motion along the path.
struct Control {
  Dialect dialect = Dialect::linuxcnc;
  double interpolator_period_s = 0.001;
  double servo_period_s = 0.001;
  double max_path_acceleration_mm_s2 = kUnlimited;  ///< along the path, on top of the axes' own
  double max_path_jerk_mm_s3 = kUnlimited;
  double max_feed_mm_s = kUnlimited;
  double rapid_mm_s = kUnlimited;  ///< path speed of G0, on top of the axes' own
  std::uint32_t look_ahead_blocks = 100;
  double corner_tolerance_mm =
      0.0;  ///< G64 without P; 0 = as fast as the junction allows on the exact path
  double junction_deviation_mm = 0.01;  ///< bound on the speed at a corner of the exact path
  double tool_change_s = 5.0;
  double centripetal_share = 0.866;  ///< share of the axes' acceleration that arcs may use across
                                     ///< the path; the rest is for speed changes
  double blend_share = 0.5;  ///< a corner arc takes at most this share of each of its neighbours
  double min_block_cycles = 0.0;  ///< a block takes at least this many interpolator periods
  double merge_share =
      0.0;  ///< lines merge while within this share of the program's own tolerance; 0 = never
  double junction_share =
      1.0;  ///< share of an axis's acceleration that a corner of the exact path may use in one
            ///< period; below 1 the rest is what its neighbours keep
  double corner_acceleration_share =
      1.0;  ///< continuous mode: what is left of the acceleration beside a corner that could not be
            ///< rounded and before a stop
  double blend_gap_cycles = 0.0;  ///< what a corner arc leaves of the line before it keeps the
                                  ///< arc's limits when it is shorter than this many periods
  bool stop_between_rapid_and_feed = false;
};

struct Spindle {
  double max_rev_s = 200.0;
  double min_rev_s = 0.0;
  double acceleration_rev_s2 = 50.0;
  double inertia_kg_m2 = 0.01;
  double rated_power_w = 10e3;
  double max_torque_n_m = 70.0;
  double rated_torque_n_m = kUnlimited;  ///< RMS, for ever (S1); without it the largest torque
  double speed_tolerance_ratio = 0.10;   ///< band of the control's speed monitor about its
                                         ///< set-point; 0 = the control has none
};

enum class ContourStrategy : std::uint8_t { contour_priority, feed_priority, combined };

/// What the contour room may do on this machine.
struct Contour {
  bool enabled = true;
  ContourStrategy strategy = ContourStrategy::feed_priority;
  double limit_mm = 0.010;  ///< ε_max
  double target_mm = 0.0;   ///< contour priority: errors below this count as equal
  double min_ratio =
      0.10;                ///< the layer never asks for less than this share of the programmed feed
  double max_ratio = 1.0;  ///< nor for more than this
  double weight_contour = 0.25;  ///< w1 of the combined objective
  double weight_feed = 0.75;     ///< w2
  double margin =
      0.05;  ///< share of the limit kept in reserve against what the model does not know
};

/// Shapes of the spindle's speed, in the order of chatter::online::Law.
enum class SpeedLaw : std::uint8_t { constant, square, pulse, triangle, sine, random, stop };

/// What the chatter room may do on this machine.
struct Chatter {
  bool enabled = false;
  SpeedLaw law = SpeedLaw::triangle;
  double amplitude_ratio = 0.10;  ///< of the mean speed, to either side
  double amplitude_rev_s = 0.0;   ///< the same as a speed; 0 = `amplitude_ratio` counts
  double period_s = 2.0;
  double mean_ratio = 1.0;                ///< of the programmed speed
  double min_feed_per_tooth_ratio = 0.8;  ///< of the programmed feed per tooth
  double max_feed_per_tooth_ratio = 1.2;
  std::uint32_t m_code_on = 38;  ///< 0 = always on, the program has no say
  std::uint32_t m_code_off = 39;
  std::uint64_t seed = 1;
};

/// How corrections are written into the text of this machine's programs (nc/rewrite).
enum class CompensationMethod : std::uint8_t {
  by_dialect,    ///< the one that linuxcnc and fanuc have; sinumerik has none
  linuxcnc,      ///< G10 L20 in the active work offset
  fanuc,         ///< G10 L2 P0, the external work offset
  haas,          ///< G10 L2 P1 … P6, the active work offset
  r_parameter,   ///< sinumerik: an R-parameter that the PLC takes over
  setting_data,  ///< sinumerik: $SA_TEMP_COMP_ABS_VALUE
  frame_fine     ///< sinumerik: $P_IFRAME[axis,FI], the active frame's fine offset
};

struct Compensation {
  CompensationMethod method = CompensationMethod::by_dialect;
  std::uint32_t r_parameter = 0;  ///< its number
  std::int64_t sign = 0;  ///< +1: a positive value moves the axis to larger positions; −1: to
                          ///< smaller ones; 0: not known
  bool external_offset_free = false;  ///< fanuc: 0 whenever a program starts
  /// Nobody touches off while a correction of an aborted run stands: it is taken off before.
  bool cleared_after_abort = false;
  double least_increment_mm = 1e-3;  ///< what the control takes of a correction, mm programs
};

/// The last step before any write; the layer cannot switch it off.
struct Envelope {
  double min_feed_ratio = 0.0;
  double max_feed_ratio = 1.2;
  double feed_fall_1_s = 10.0;  ///< slew limits of the ratio, per second
  double feed_rise_1_s = 2.0;
  double min_spindle_ratio = 0.5;
  double max_spindle_ratio = 1.2;
  double spindle_slew_1_s = 2.0;
  double max_offset_mm = 0.2;
  double offset_slew_mm_s = 0.05;
  double stale_after_s = 0.1;  ///< older input is not acted on
};

enum class Mode : std::uint8_t { observe, advise, act };

/// Numbers that belong to the simulated machine alone.
struct Simulation {
  std::uint64_t seed = 1;
  double position_noise_mm = 0.0;  ///< RMS of what disturbs the true position (vibration, load)
  // Heat: the truth is the thermal passport, less what these say.
  std::vector<double>
      thermal_tau_error_ratio;  ///< in the order of Thermal::terms(); the last for the rest
  std::vector<double> thermal_gain_error_ratio;  ///< likewise: of the levels and ambient gains
  double room_c = 20.0;                          ///< mean temperature of the room
  double room_swing_k = 0.0;                     ///< amplitude over the day, warmest at 15 o'clock
  double room_noise_k = 0.0;                     ///< RMS of what doors and draughts do to it
  double room_start_s = 8.0 * 3600.0;            ///< time of day at which the simulation begins
  double sensor_noise_k = 0.0;                   ///< RMS of one reading of a temperature
  double probe_noise_mm = 0.0;                   ///< RMS of one reading of the probe
};

struct Machine {
  std::string name = "machine";
  std::string file;  ///< where it was read; empty when built in code
  PortKind port = PortKind::sim;
  Mode mode = Mode::observe;
  Control control;
  std::vector<Axis> axes;  ///< X, Y, Z first
  OverrideTable feed_override;
  OverrideTable rapid_override;
  OverrideTable spindle_override;
  Spindle spindle;
  Contour contour;
  Chatter chatter;
  Compensation compensation;
  Thermal thermal;
  Envelope envelope;
  Simulation simulation;
};

}  // namespace steadyrest::kernel::machine
