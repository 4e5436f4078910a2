// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <utility>

#include <steadyrest/passport/keys/choice.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// The schema: one table of keys for reading, for the refusals' ranges, for writing and for the
// reference page. Adding a key is one row here and one field in the struct.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Coding;
using kernel::machine::Control;
using kernel::machine::Dialect;
using kernel::machine::Encoder;
using kernel::machine::Friction;
using kernel::machine::Machine;
using kernel::machine::Mode;
using kernel::machine::PortKind;
using kernel::machine::Simulation;
using kernel::machine::Spindle;

using std::string_view;

constexpr std::array<string_view, 5> kPorts = {"sim", "linuxcnc", "lines", "opcua", "replay"};
/// Those with an adapter; a file with another one is refused.
constexpr auto kBuiltPorts = std::span(kPorts).first<4>();
constexpr std::array<string_view, 3> kModes = {"observe", "advise", "act"};
constexpr std::array<string_view, 2> kCodings = {"gray", "binary"};
constexpr std::array<string_view, 2> kAccelerationModes = {"soft", "brisk"};
constexpr std::array<string_view, 2> kPlanners = {"trapezoid", "s_curve"};
constexpr std::array<string_view, 3> kProgramUnits = {"unknown", "mm", "inch"};

constexpr auto kMust = Need::mandatory;
constexpr auto kMay = Need::optional;
constexpr auto kLinear = For::linear;
constexpr auto kRotary = For::rotary;

/// Language, periods and limits of a control.
auto limit_keys() noexcept {
  return std::array{
      Key<Control>{"dialect", choice<Control, &Control::dialect>(kernel::machine::kDialectNames), 0,
                   0, "Language of the control's NC programs.", kMust},
      Key<Control>{"units", choice<Control, &Control::units>(kProgramUnits), 0, 0,
                   "Unit in force at a program's start, for programs without G20 or G21 (G70, G71, "
                   "G700, G710): LinuxCNC's `LINEAR_UNITS`, FANUC's parameter 0#2, SINUMERIK's G "
                   "group 13 in MD20150 with MD10240. With `unknown` mm are assumed and such a "
                   "program is not rewritten."},
      Key<Control>{
          "interpolator_period_ms", &Control::interpolator_period_s, 0.05, 100,
          "Time between set-points from the interpolator; a whole multiple of `servo_period_ms`."},
      Key<Control>{"servo_period_ms", &Control::servo_period_s, 0.05, 100,
                   "Period of the position loop."},
      // Limits along the path come on top of the axes' own: whichever is reached first decides.
      Key<Control>{"max_path_acceleration_mm_s2", &Control::max_path_acceleration_mm_s2, 1, 1e6,
                   "Acceleration limit along the path, in addition to the axes' own."},
      Key<Control>{"max_path_jerk_mm_s3", &Control::max_path_jerk_mm_s3, 1, 1e9,
                   "Jerk limit along the path, in addition to the axes' own."},
      Key<Control>{"max_feed_mm_min", &Control::max_feed_mm_s, 1, 1e6,
                   "Largest path feed that the control accepts."},
      Key<Control>{"rapid_mm_min", &Control::rapid_mm_s, 1, 1e6,
                   "G0 speed along the path, in addition to the axes' own limits."},
      Key<Control>{"look_ahead_blocks", &Control::look_ahead_blocks, 1, 10000,
                   "Number of blocks the control looks ahead."},
      Key<Control>{"corner_tolerance_mm", &Control::corner_tolerance_mm, 0, 10,
                   "Rounding tolerance of a G64 without a value; 0 stays on the exact path."},
      // The speed through a corner that is not rounded: as on an arc of this deviation, with the
      // axes' acceleration across it.
      Key<Control>{"junction_deviation_mm", &Control::junction_deviation_mm, 0, 1,
                   "Speed limit through a corner of the exact path."},
      Key<Control>{"tool_change_s", &Control::tool_change_s, 0, 3600, "Time for one tool change."},
  };
}

/// What imitates a real control's planner; program times depend on it.
auto planner_keys() noexcept {
  return std::array{
      Key<Control>{"centripetal_share", &Control::centripetal_share, 0.1, 0.999,
                   "Share of the axes' acceleration that arcs may use across the path."},
      Key<Control>{"blend_share", &Control::blend_share, 0.01, 0.5,
                   "A corner arc takes at most this share of each of its neighbours."},
      Key<Control>{"blend_gap_cycles", &Control::blend_gap_cycles, 0, 1000,
                   "If the line left over before a corner arc is shorter than this many "
                   "interpolator periods, it keeps the arc's acceleration."},
      Key<Control>{"min_block_cycles", &Control::min_block_cycles, 0, 1000,
                   "A block takes at least this many interpolator periods."},
      Key<Control>{
          "block_time_ms", &Control::block_time_s, 0, 1000,
          "A block takes at least this long, a spline as a whole: about 4 ms on a SINUMERIK 840D, "
          "10 to 20 on older controls. Without it 20 ms are assumed, but on LinuxCNC, which takes "
          "`min_block_cycles`; `program check` says where that slows a cut."},
      Key<Control>{"exact_stop_um", &Control::exact_stop_mm, 0, 1000,
                   "An exact stop (G9, G60, G61.1) lasts until the axes are this near by their "
                   "servo gain, as SINUMERIK's MD36010 and MD36000 say; 0 = no wait."},
      Key<Control>{
          "acceleration_mode", choice<Control, &Control::acceleration_mode>(kAccelerationModes), 0,
          0,
          "`soft`: the jerk limits hold (SINUMERIK's SOFT). `brisk`: they do not, and the "
          "acceleration begins at once (BRISK, in force where MD20150 does not say SOFT)."},
      Key<Control>{"planner", choice<Control, &Control::planner>(kPlanners), 0, 0,
                   "LinuxCNC's `PLANNER_TYPE`: `trapezoid` is 0 and that of 2.9; `s_curve` is 1 or "
                   "2 of 2.10, with `max_path_jerk_mm_s3`. Then G61 passes corners between lines "
                   "at `junction_share` instead of stopping there."},
      Key<Control>{"merge_share", &Control::merge_share, 0, 1,
                   "Lines are merged while all points lie within this share of the program's "
                   "tolerance; 0 = never."},
      Key<Control>{
          "junction_share", &Control::junction_share, 0.001, 1,
          "LinuxCNC's ARC_BLEND_KINK_RATIO: share of the axes' acceleration that a corner "
          "may take in one interpolator period at the feed. Beyond it the exact path stops "
          "there; 1 = no such law."},
      Key<Control>{"corner_acceleration_share", &Control::corner_acceleration_share, 0.01, 1,
                   "Continuous mode: share of the acceleration left next to an unrounded corner, "
                   "and before a stop."},
      Key<Control>{"clips_programmed_feed", &Control::clips_programmed_feed, 0, 0,
                   "A programmed F above the axes' speeds is clipped to them before the override "
                   "multiplies it, as on LinuxCNC. Otherwise the override multiplies F itself, so "
                   "it slows such a block only once the product drops below those speeds."},
      Key<Control>{"stop_between_rapid_and_feed", &Control::stop_between_rapid_and_feed, 0, 0,
                   "The control stops between G0 and a feed move."},
  };
}

template <std::size_t First, std::size_t Second>
auto joined(const std::array<Key<Control>, First>& first,
            const std::array<Key<Control>, Second>& second) noexcept {
  return [&]<std::size_t... I, std::size_t... J>(std::index_sequence<I...>,
                                                 std::index_sequence<J...>) {
    return std::array{first[I]..., second[J]...};
  }(std::make_index_sequence<First>{}, std::make_index_sequence<Second>{});
}

}  // namespace

/// Only built ports are allowed, so a machine file cannot promise a port that does nothing.
std::span<const Key<Machine>> top_keys() noexcept {
  static const std::array kKeys = {
      Key<Machine>{"name", &Machine::name, 1, 80, "Name of the machine in reports."},
      Key<Machine>{"port", choice<Machine, &Machine::port>(kBuiltPorts), 0, 0,
                   "The port to the machine: `sim`, the simulated machine; `linuxcnc`, a running "
                   "LinuxCNC; `lines`, the override lines between panel and control; `opcua`, a "
                   "control behind its OPC UA server."},
      Key<Machine>{"mode", choice<Machine, &Machine::mode>(kModes), 0, 0,
                   "`observe` writes nothing, `advise` shows what it would write, `act` writes."},
  };
  return kKeys;
}

/// How the control plans. Periods fix the grid of the simulated control; shares and tolerances
/// imitate the look-ahead of the real one.
std::span<const Key<Control>> control_keys() noexcept {
  static const auto kKeys = joined(limit_keys(), planner_keys());
  return kKeys;
}

/// Two keys of one stem with different units (servo_gain) fill one field; giving both is refused.
/// Rotary axes have keys in degrees for fields that hold rad.
std::span<const Key<Axis>> axis_keys() noexcept {
  static const std::array kKeys = {
      Key<Axis>{"name", &Axis::name, 1, 1, "One of X Y Z U V W (linear) or A B C (rotary).", kMust},
      Key<Axis>{"servo_gain_1_s", &Axis::servo_gain_1_s, 1, 1000,
                "Position loop gain: speed over following error.", kMust},
      // Kv in the unit of the control's own parameter, as drawings and commissioning sheets give
      // it.
      Key<Axis>{"servo_gain_m_min_mm", &Axis::servo_gain_1_s, 0.06, 60,
                "The same in the unit of SINUMERIK MD32200: 1 (m/min)/mm = 16.667 1/s.", kMust},
      Key<Axis>{"feed_forward", &Axis::feed_forward, 0, 1.5,
                "Weight of the velocity feed-forward: 0 none, 1 full."},
      Key<Axis>{"velocity_lag_ms", &Axis::velocity_lag_s, 0, 500,
                "First-order lag of the closed velocity loop; 0 = none. Without the key it is not "
                "known: 0 is taken, and `program predistort` changes only what gets no worse with "
                "any lag up to half of 1 / servo gain. `machine from-log` fits it."},
      Key<Axis>{"max_feed_mm_min", &Axis::max_speed_au_s, 1, 1e6, "Largest speed of the axis.",
                kMust, kLinear},
      Key<Axis>{"max_speed_deg_s", &Axis::max_speed_au_s, 0.01, 1e5, "Largest speed of the axis.",
                kMust, kRotary},
      Key<Axis>{"max_acceleration_mm_s2", &Axis::max_acceleration_au_s2, 1, 1e6,
                "Largest acceleration that the control plans with.", kMust, kLinear},
      Key<Axis>{"max_acceleration_deg_s2", &Axis::max_acceleration_au_s2, 0.1, 1e6,
                "Largest acceleration that the control plans with.", kMust, kRotary},
      Key<Axis>{"max_jerk_mm_s3", &Axis::max_jerk_au_s3, 1, 1e9,
                "Largest jerk that the control plans with.", kMay, kLinear},
      Key<Axis>{"max_jerk_deg_s3", &Axis::max_jerk_au_s3, 1, 1e9,
                "Largest jerk that the control plans with.", kMay, kRotary},
      // The drive's own limit is above the one the control plans with; otherwise the axis falls
      // behind the plan.
      Key<Axis>{"drive_acceleration_mm_s2", &Axis::drive_acceleration_au_s2, 1, 1e6,
                "What the drive delivers at its current limit; the servo saturates there.", kMay,
                kLinear},
      Key<Axis>{"drive_acceleration_deg_s2", &Axis::drive_acceleration_au_s2, 0.1, 1e6,
                "What the drive delivers at its current limit; the servo saturates there.", kMay,
                kRotary},
      Key<Axis>{"backlash_um", &Axis::backlash_au, 0, 5000, "Lost motion at a reversal.", kMay,
                kLinear},
      Key<Axis>{"backlash_deg", &Axis::backlash_au, 0, 10, "Lost motion at a reversal.", kMay,
                kRotary},
      Key<Axis>{"min_mm", &Axis::min_au, -1e6, 1e6, "Lower end of travel, machine coordinates.",
                kMay, kLinear},
      Key<Axis>{"max_mm", &Axis::max_au, -1e6, 1e6, "Upper end of travel.", kMay, kLinear},
      Key<Axis>{"min_deg", &Axis::min_au, -1e8, 1e8, "Lower end of travel, machine coordinates.",
                kMay, kRotary},
      Key<Axis>{"max_deg", &Axis::max_au, -1e8, 1e8, "Upper end of travel.", kMay, kRotary},
  };
  return kKeys;
}

/// A calibration comes with the axis because it belongs to one scale, not to a type of machine.
std::span<const Key<Encoder>> encoder_keys() noexcept {
  static const std::array kKeys = {
      Key<Encoder>{"count_um", &Encoder::count_au, 0, 1000,
                   "Length of one count after ×4 decoding; 0 = ideal.", kMay, kLinear},
      Key<Encoder>{"count_deg", &Encoder::count_au, 0, 10,
                   "Angle of one count after ×4 decoding; 0 = ideal.", kMay, kRotary},
      Key<Encoder>{"line_error_um", &Encoder::line_error_au, 0, 1000,
                   "Amplitude of the error that repeats with each line.", kMay, kLinear},
      Key<Encoder>{"line_error_deg", &Encoder::line_error_au, 0, 10,
                   "Amplitude of the error that repeats with each line.", kMay, kRotary},
      Key<Encoder>{"line_period_um", &Encoder::line_period_au, 0.001, 1e5, "Length of one line.",
                   kMay, kLinear},
      Key<Encoder>{"line_period_deg", &Encoder::line_period_au, 1e-6, 360, "Angle of one line.",
                   kMay, kRotary},
      Key<Encoder>{"clock_ns", &Encoder::clock_s, 0, 1e6,
                   "Period of the clock that time-stamps the edges; 0 = no time stamps."},
      // A line of the encoder has four edges, and each kind of edge is off by its own amount, the
      // same on every line: the phase errors. The rest differs from line to line: the line table.
      Key<Encoder>{"phase_error_um", &Encoder::phase_error_au, -1000, 1000,
                   "Calibration: position errors of the four edges of a line, edge number mod 4 = "
                   "0, 1, 2, 3; their sum is 0 and each is less than a count.",
                   kMay, kLinear, 4},
      Key<Encoder>{"phase_error_deg", &Encoder::phase_error_au, -10, 10,
                   "Calibration: position errors of the four edges of a line, edge number mod 4 = "
                   "0, 1, 2, 3; their sum is 0 and each is less than a count.",
                   kMay, kRotary, 4},
      Key<Encoder>{"line_table_first", &Encoder::line_table_first, -1e12, 1e12,
                   "Calibration: number of the first edge in the table."},
      Key<Encoder>{"line_table_periodic", &Encoder::line_table_periodic, 0, 0,
                   "Calibration: the table covers one revolution and repeats."},
      Key<Encoder>{"line_table_um", &Encoder::line_table_au, -1000, 1000,
                   "Calibration: further position error of each edge, at most 1 048 576 entries, "
                   "each less than a count; 0 = unknown. `steadyrest motion calibrate` writes it.",
                   kMay, kLinear, kMaxLineTable},
      Key<Encoder>{"line_table_deg", &Encoder::line_table_au, -10, 10,
                   "Calibration: further position error of each edge, at most 1 048 576 entries, "
                   "each less than a count; 0 = unknown. `steadyrest motion calibrate` writes it.",
                   kMay, kRotary, kMaxLineTable},
  };
  return kKeys;
}

/// Friction as an acceleration (force over moved mass), so that no mass has to be known.
std::span<const Key<Friction>> friction_keys() noexcept {
  static const std::array kKeys = {
      Key<Friction>{"coulomb_mm_s2", &Friction::coulomb_au_s2, 0, 1e5,
                    "Sliding friction as an acceleration: force over moved mass.", kMay, kLinear},
      Key<Friction>{"coulomb_deg_s2", &Friction::coulomb_au_s2, 0, 1e6,
                    "Sliding friction as an acceleration: torque over moved inertia.", kMay,
                    kRotary},
      Key<Friction>{"breakaway_mm_s2", &Friction::breakaway_au_s2, 0, 1e5,
                    "Friction at the start of motion; not below the sliding friction.", kMay,
                    kLinear},
      Key<Friction>{"breakaway_deg_s2", &Friction::breakaway_au_s2, 0, 1e6,
                    "Friction at the start of motion; not below the sliding friction.", kMay,
                    kRotary},
      Key<Friction>{"stribeck_mm_s", &Friction::stribeck_au_s, 1e-6, 1e3,
                    "Speed over which the breakaway part decays.", kMay, kLinear},
      Key<Friction>{"stribeck_deg_s", &Friction::stribeck_au_s, 1e-6, 1e4,
                    "Speed over which the breakaway part decays.", kMay, kRotary},
      Key<Friction>{"viscous_1_s", &Friction::viscous_1_s, 0, 1e4,
                    "Friction that grows with speed."},
  };
  return kKeys;
}

/// binary_max_percent and percent exclude each other; override_table.cpp makes the table from
/// either.
std::span<const Key<OverrideKeys>> override_keys() noexcept {
  using O = OverrideKeys;
  static const std::array kKeys = {
      Key<O>{"coding", choice<O, &O::coding>(kCodings), 0, 0, "Coding of the switch's word."},
      Key<O>{"percent", &O::percent, 0, 1000,
             "The value of each step, from the first step up, never falling. Either this or "
             "`binary_max_percent`."},
      Key<O>{"codes", &O::codes, 0, 65535,
             "The word of each step: one per entry of `percent`, all different. By default the "
             "Gray code of 1, 2, 3 … (`gray`) or the percent itself (`binary`)."},
      Key<O>{"binary_max_percent", &O::binary_max, 1, 1000,
             "Binary switch with even steps from 0 to this value; the word is the step number."},
      Key<O>{"binary_step_percent", &O::binary_step, 0.05, 50,
             "Size of those steps; 2001 steps at most."},
      // Together with dead_time_ms this decides how far ahead the layer must look.
      Key<O>{"scan_period_ms", &O::scan_period_s, 0.05, 10000,
             "How often the PLC (or whatever reads the switch) scans the word."},
      Key<O>{"dead_time_ms", &O::dead_time_s, 0, 10000,
             "Time from that scan until the interpolator acts."},
      Key<O>{"latched_word", &O::latched_word, 0, 0,
             "A written word takes effect all at once; if not, the layer steps through "
             "neighbouring codes."},
      Key<O>{"layer_may_exceed_panel", &O::layer_may_exceed_panel, 0, 0,
             "The layer may ask for more than the operator's switch. 0 on the panel always stops."},
      Key<O>{"max_percent", &O::max_ratio, 1, 1000, "The control clips at this value."},
  };
  return kKeys;
}

/// The drive's limits decide which speed laws it can follow: acceleration for the slope, RMS torque
/// for the heat of the motor.
std::span<const Key<Spindle>> spindle_keys() noexcept {
  static const std::array kKeys = {
      Key<Spindle>{"max_rpm", &Spindle::max_rev_s, 1, 1e6, "Largest speed."},
      Key<Spindle>{"min_rpm", &Spindle::min_rev_s, 0, 1e6, "Smallest speed."},
      Key<Spindle>{"acceleration_rpm_s", &Spindle::acceleration_rev_s2, 1, 1e6,
                   "Rate at which the drive changes the speed."},
      Key<Spindle>{"inertia_kg_m2", &Spindle::inertia_kg_m2, 1e-7, 1e4,
                   "Moment of inertia of rotor, chuck and tool."},
      Key<Spindle>{"rated_power_kw", &Spindle::rated_power_w, 0.001, 1e4, "Rated power."},
      Key<Spindle>{"max_torque_n_m", &Spindle::max_torque_n_m, 0.001, 1e6, "Largest torque."},
      // A modulated spindle works against its own inertia all the time; the RMS of that torque must
      // stay below the motor's continuous rating.
      Key<Spindle>{"rated_torque_n_m", &Spindle::rated_torque_n_m, 0.001, 1e6,
                   "Continuous RMS torque of the motor (S1); default `max_torque_n_m`."},
      Key<Spindle>{"speed_tolerance_percent", &Spindle::speed_tolerance_ratio, 0, 100,
                   "Tolerance band of the control's speed monitor (MD35150 on an 840D); 0: the "
                   "control has none."},
  };
  return kKeys;
}

/// True values that differ from the passport: without them the simulated machine would drift
/// exactly as forecast, and the correction would look perfect.
std::span<const Key<Simulation>> simulation_keys() noexcept {
  static const std::array kKeys = {
      Key<Simulation>{"seed", &Simulation::seed, 0, 9007199254740992.0,
                      "Seed for all noise: same seed, same output, byte for byte."},
      Key<Simulation>{"position_noise_um", &Simulation::position_noise_mm, 0, 1000,
                      "RMS disturbance of the true position (vibration, load)."},
      Key<Simulation>{
          "thermal_tau_error_percent", &Simulation::thermal_tau_error_ratio, -90, 1000,
          "How much longer the true time constants are than the thermal passport's: one value for "
          "each mode, then each ambient input, axis by axis; the last applies to the rest.",
          kMay, For::any, 72},
      Key<Simulation>{"thermal_gain_error_percent", &Simulation::thermal_gain_error_ratio, -100,
                      1000,
                      "How much larger the true levels and ambient gains are than the passport's, "
                      "in the same order.",
                      kMay, For::any, 72},
      // The shop around the simulated machine: a daily swing, draughts, and sensors that measure
      // both with noise.
      Key<Simulation>{"room_c", &Simulation::room_c, -20, 60, "Mean shop temperature."},
      Key<Simulation>{"room_swing_k", &Simulation::room_swing_k, 0, 30,
                      "Amplitude of the shop temperature over a day, warmest at 15:00."},
      Key<Simulation>{
          "room_noise_k", &Simulation::room_noise_k, 0, 10,
          "RMS temperature change from doors and draughts, with a correlation time of 10 min."},
      Key<Simulation>{"room_start_h", &Simulation::room_start_s, 0, 24,
                      "Time of day at the start of the simulation."},
      Key<Simulation>{"sensor_noise_k", &Simulation::sensor_noise_k, 0, 10,
                      "RMS noise of a temperature reading."},
      Key<Simulation>{"probe_noise_um", &Simulation::probe_noise_mm, 0, 1000,
                      "RMS noise of a probe reading that re-zeroes the thermal model."},
  };
  return kKeys;
}

/// The words of a choice, as the file spells them.
string_view word(PortKind port) noexcept {
  return pick(kPorts, port);
}
string_view word(Mode mode) noexcept {
  return pick(kModes, mode);
}
string_view word(Dialect dialect) noexcept {
  return pick(kernel::machine::kDialectNames, dialect);
}
string_view word(Coding coding) noexcept {
  return pick(kCodings, coding);
}

}  // namespace steadyrest::passport
