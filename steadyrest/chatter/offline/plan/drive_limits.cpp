// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/plan/drive_limits.hpp>
#include <steadyrest/chatter/offline/plan/same.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Each check adds its own violations and none stops at the first: the report shows every limit that
// a law exceeds. most_rvf() then bisects, since every demand grows with the RVF.
namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kTurn;
using online::Law;
using online::SpeedLaw;

constexpr std::size_t kPhases = 1024;  ///< a multiple of the random law's knots
// Fewer than eight scans per period turn a sine or triangle into little more than a square.
constexpr double kLeastScans = 8.0;
constexpr double kMostRampShare = 0.2;
constexpr double kMostLevelError = 0.25;  ///< of the amplitude

/// Mean force along the cut times its path in one revolution, N·mm; times 1e-3, W·s at 1 rev/s.
double work_per_rev_n_mm(const Process& process, double depth_mm) {
  const Cut& cut = process.cut;
  if (cut.operation == Operation::turning) {
    const double path = std::numbers::pi * process.tool.diameter_mm;
    return depth_mm * path *
           (cut.tangential_n_mm2 * cut.feed_per_tooth_mm + cut.edge_tangential_n_mm);
  }
  const double radius = 0.5 * process.tool.diameter_mm;
  const double entry = process.entry_rad();
  const double exit = process.exit_rad();
  const double chip = cut.feed_per_tooth_mm * (std::cos(entry) - std::cos(exit));  // ∫ fz·sin φ
  return static_cast<double>(process.tool.teeth) * depth_mm * radius *
         (cut.tangential_n_mm2 * chip + cut.edge_tangential_n_mm * (exit - entry));
}

double rpm(double rev_s) {
  return 60.0 * rev_s;
}

/// Two numbers with as many decimals as needed to tell them apart, at least two.
struct Apart {
  std::string needed;
  std::string given;
};

Apart apart(double needed, double given) {
  constexpr int kMostDecimals = 12;
  for (int decimals = 2;; ++decimals) {
    Apart out{fmt::format("{:.{}f}", needed, decimals), fmt::format("{:.{}f}", given, decimals)};
    if (out.needed != out.given || decimals == kMostDecimals) {
      return out;
    }
  }
}

void add(DriveDemand& out, DriveLimit limit, std::string reason) {
  out.violations.push_back({limit, std::move(reason)});
}

}  // namespace

/// The properties of S that the limits need.
struct DriveLimits::Shape {
  double low = 0.0;
  double high = 0.0;
  double steepest = 0.0;       ///< max |dS/du| of a swept law
  double steep_square = 0.0;   ///< mean of (dS/du)²
  double steep_power = 0.0;    ///< max of (1 + RVA·S)·|dS/du|
  double shortest_part = 1.0;  ///< of a law with jumps, in periods
  std::vector<double> at;      ///< S at kPhases even phases
};

DriveLimits::DriveLimits(const kernel::machine::Machine& machine, const Process& process,
                         double depth_mm, const Options& options)
    : spindle_(machine.spindle),
      table_(machine.spindle_override),
      envelope_(machine.envelope),
      options_(options),
      // N·mm per revolution to W·s per revolution.
      power_per_rev_w_s_(1e-3 * work_per_rev_n_mm(process, depth_mm)) {
  // [spindle] rated_torque_n_m is optional and then means the peak torque.
  if (!std::isfinite(spindle_.rated_torque_n_m)) {
    spindle_.rated_torque_n_m = spindle_.max_torque_n_m;
  }
}

double DriveLimits::cutting_power_w(double speed_rev_s) const noexcept {
  return power_per_rev_w_s_ * speed_rev_s;
}

std::vector<double> DriveLimits::writable(double programmed_rev_s) const {
  std::vector<double> out;
  for (const double ratio : table_.ratio) {
    const double speed = programmed_rev_s * ratio;
    if (ratio > 0.0 && ratio <= table_.max_ratio + kSame &&
        ratio >= envelope_.min_spindle_ratio - kSame &&
        ratio <= envelope_.max_spindle_ratio + kSame &&
        speed >= spindle_.min_rev_s * (1.0 - kSame) &&
        speed <= spindle_.max_rev_s * (1.0 + kSame)) {
      out.push_back(ratio);
    }
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

DriveDemand DriveLimits::constant(double programmed_rev_s, double ratio) const {
  DriveDemand out;
  out.written_ratio = {ratio};
  const double speed = programmed_rev_s * ratio;
  if (speed > spindle_.max_rev_s * (1.0 + kSame) || speed < spindle_.min_rev_s * (1.0 - kSame)) {
    add(out, DriveLimit::speed,
        fmt::format("{:.0f} rpm is outside the spindle's {:.0f} … {:.0f} rpm", rpm(speed),
                    rpm(spindle_.min_rev_s), rpm(spindle_.max_rev_s)));
  }
  out.power_w = cutting_power_w(speed);
  out.torque_n_m = power_per_rev_w_s_ / kTurn;
  out.rms_torque_n_m = out.torque_n_m;
  check_load(speed, out);
  return out;
}

DriveLimits::Shape DriveLimits::shape(const Modulation& modulation) const {
  const SpeedLaw law(modulation.law, modulation.seed);
  Shape out;
  for (std::size_t i = 0; i < kPhases; ++i) {
    out.at.push_back(law.at(static_cast<double>(i) / static_cast<double>(kPhases)));
  }
  out.low = *std::ranges::min_element(out.at);
  out.high = *std::ranges::max_element(out.at);
  if (online::jumps(modulation.law)) {
    for (std::size_t k = 0; k < law.corner_count(); ++k) {
      const double next = k + 1 < law.corner_count() ? law.corners()[k + 1] : 1.0;
      out.shortest_part = std::min(out.shortest_part, next - law.corners()[k]);
    }
    return out;
  }
  for (std::size_t i = 0; i < kPhases; ++i) {
    const double next = out.at[(i + 1) % kPhases];
    double slope = std::abs(next - out.at[i]) * static_cast<double>(kPhases);
    double value = std::max(next, out.at[i]);
    // In closed form: finite differences would underestimate the greatest slope.
    if (modulation.law == Law::sine) {
      slope = kTurn * std::abs(std::cos(kTurn * static_cast<double>(i) / kPhases));
      value = out.at[i];
    }
    out.steepest = std::max(out.steepest, slope);
    out.steep_square += slope * slope / static_cast<double>(kPhases);
    out.steep_power = std::max(out.steep_power, (1.0 + modulation.rva * value) * slope);
  }
  return out;
}

DriveDemand DriveLimits::modulated(double programmed_rev_s, const Modulation& modulation) const {
  if (modulation.law == Law::constant || modulation.rva == 0.0) {
    return constant(programmed_rev_s, 1.0);
  }
  DriveDemand out;
  const Shape s = shape(modulation);
  check_levels(programmed_rev_s, modulation, s, out);
  const double scans = 1.0 / (modulation.rvf * programmed_rev_s * table_.scan_period_s);
  if (scans < kLeastScans * (1.0 - kSame)) {
    add(out, DriveLimit::scan,
        fmt::format(
            "a period of {:.0f} ms has {:.1f} override scans; it needs {:.0f} (RVF {:.3g} at most)",
            1e3 * scans * table_.scan_period_s, scans, kLeastScans,
            modulation.rvf * scans / kLeastScans));
  }
  if (online::jumps(modulation.law)) {
    check_jumps(programmed_rev_s, modulation, s, out);
  } else {
    check_sweep(programmed_rev_s, modulation, s, out);
  }
  check_load(programmed_rev_s, out);
  check_monitor(programmed_rev_s, modulation, s, out);
  return out;
}

/// Checks each phase at the nearest step.
void DriveLimits::check_levels(double speed, const Modulation& m, const Shape& s,
                               DriveDemand& out) const {
  const std::vector<double> steps = writable(speed);
  if (steps.empty()) {
    add(out, DriveLimit::levels, "no override step may be written at this speed");
    return;
  }
  double worst = 0.0;
  for (const double value : s.at) {
    // The modulator rounds each phase to the nearest step; between steps the law is a staircase.
    const double want = 1.0 + m.rva * value;
    const double step = *std::ranges::min_element(
        steps, {}, [want](double ratio) { return std::abs(ratio - want); });
    worst = std::max(worst, std::abs(step - want));
    out.written_ratio.push_back(step);
  }
  std::ranges::sort(out.written_ratio);
  out.written_ratio.erase(std::unique(out.written_ratio.begin(), out.written_ratio.end()),
                          out.written_ratio.end());
  if (worst > kMostLevelError * m.rva + kSame) {
    add(out, DriveLimit::levels,
        fmt::format("the override can write {:.4g} … {:.4g} %; it gets no nearer than {:.2g} % to "
                    "{:.4g} … {:.4g} %, and a quarter of the amplitude is allowed",
                    100.0 * steps.front(), 100.0 * steps.back(), 100.0 * worst,
                    100.0 * (1.0 + m.rva * s.low), 100.0 * (1.0 + m.rva * s.high)));
  }
}

/// The greatest gap between the steps that a law uses.
double DriveLimits::step_ratio(const DriveDemand& demand) const noexcept {
  double out = 0.0;
  for (std::size_t i = 1; i < demand.written_ratio.size(); ++i) {
    out = std::max(out, demand.written_ratio[i] - demand.written_ratio[i - 1]);
  }
  return out;
}

void DriveLimits::check_sweep(double speed, const Modulation& m, const Shape& s,
                              DriveDemand& out) const {
  // N(t) = N₀·(1 + RVA·S(f·t)), so dN/dt = N₀·RVA·f·S′ with f = RVF·N₀.
  const double frequency = m.rvf * speed;
  // d(ratio)/dt in 1/s; times the speed it is rev/s².
  const double ratio_rate = m.rva * frequency * s.steepest;
  out.acceleration_rev_s2 = ratio_rate * speed;
  const auto too_fast = [&](DriveLimit limit, const char* who, double have) {
    if (ratio_rate * speed > have * (1.0 + kSame)) {
      add(out, limit,
          fmt::format("needs {:.0f} rpm/s, {} {:.0f} rpm/s (RVF {:.3g} at most)",
                      rpm(ratio_rate * speed), who, rpm(have),
                      m.rvf * have / (ratio_rate * speed)));
    }
  };
  too_fast(DriveLimit::acceleration, "the drive delivers", spindle_.acceleration_rev_s2);
  too_fast(DriveLimit::slew, "the envelope allows the override",
           envelope_.spindle_slew_1_s * speed);
  if (!table_.latched_word) {
    too_fast(DriveLimit::walk, "the override, at one step per scan, delivers",
             step_ratio(out) / table_.scan_period_s * speed);
  }
  // J·ω·dω/dt with ω = 2π·n·(1 + RVA·S): the shape's part, max (1 + RVA·S)·|S′|, follows below.
  const double turning = kTurn * kTurn * spindle_.inertia_kg_m2 * m.rva * frequency * speed * speed;
  out.power_w = turning * s.steep_power + cutting_power_w(speed);
  const double cutting = power_per_rev_w_s_ / kTurn;
  const double swing = kTurn * spindle_.inertia_kg_m2 * m.rva * frequency * speed;
  out.torque_n_m = swing * s.steepest + cutting;
  // The swing averages to 0 over a period and is uncorrelated with the constant cutting torque.
  out.rms_torque_n_m = std::sqrt(swing * swing * s.steep_square + cutting * cutting);
}

void DriveLimits::check_jumps(double speed, const Modulation& m, const Shape& s,
                              DriveDemand& out) const {
  const double jump = m.rva * (s.high - s.low);
  // In ratio per second. The slowest of drive, envelope and walked word sets the ramp.
  double rate = std::min(spindle_.acceleration_rev_s2 / speed, envelope_.spindle_slew_1_s);
  if (!table_.latched_word && out.written_ratio.size() > 1) {
    rate = std::min(rate, step_ratio(out) / table_.scan_period_s);
  }
  // A ramp of a fifth leaves four fifths of the dwell, and with them the law's effect.
  const double ramp_s = jump / rate;
  const double part_s = s.shortest_part / (m.rvf * speed);
  out.acceleration_rev_s2 = rate * speed;
  if (ramp_s > kMostRampShare * part_s * (1.0 + kSame)) {
    add(out, DriveLimit::ramp,
        fmt::format(
            "a jump of {:.0f} rpm takes {:.0f} ms; the law's shortest part is {:.0f} ms and "
            "a fifth of it is allowed (RVF {:.3g} at most)",
            rpm(jump * speed), 1e3 * ramp_s, 1e3 * part_s,
            m.rvf * kMostRampShare * part_s / ramp_s));
  }
  const double cutting = power_per_rev_w_s_ / kTurn;
  const double swing = kTurn * spindle_.inertia_kg_m2 * rate * speed;
  const double share = std::min(1.0, 2.0 * ramp_s * m.rvf * speed);  // two ramps in a period
  out.power_w = kTurn * speed * (1.0 + m.rva * s.high) * swing + cutting_power_w(speed);
  out.torque_n_m = swing + cutting;
  out.rms_torque_n_m = std::sqrt(swing * swing * share + cutting * cutting);
}

void DriveLimits::check_load(double speed, DriveDemand& out) const {
  const double cut = cutting_power_w(speed);
  if (out.power_w > spindle_.rated_power_w * (1.0 + kSame)) {
    const Apart kw = apart(1e-3 * out.power_w, 1e-3 * spindle_.rated_power_w);
    add(out, DriveLimit::power,
        fmt::format("needs {} kW ({:.2f} kW of it for the cut), the drive is rated {} kW",
                    kw.needed, 1e-3 * cut, kw.given));
  }
  if (out.torque_n_m > spindle_.max_torque_n_m * (1.0 + kSame)) {
    const Apart torque = apart(out.torque_n_m, spindle_.max_torque_n_m);
    add(out, DriveLimit::torque,
        fmt::format("needs {} N·m, the drive delivers {} N·m", torque.needed, torque.given));
  }
  if (out.rms_torque_n_m > spindle_.rated_torque_n_m * (1.0 + kSame)) {
    const Apart rms = apart(out.rms_torque_n_m, spindle_.rated_torque_n_m);
    add(out, DriveLimit::heat,
        fmt::format("loads the motor with {} N·m RMS, it is rated {} N·m", rms.needed, rms.given));
  }
}

void DriveLimits::check_monitor(double speed, const Modulation& m, const Shape& s,
                                DriveDemand& out) const {
  // SINUMERIK drops "spindle in set range" beyond MD35150 of the set-point (10 % by default) and
  // may hold the path; a relative deviation is greatest at the lowest speed.
  const double lowest = 1.0 + m.rva * s.low;
  const double off =
      online::jumps(m.law)
          ? m.rva * (s.high - s.low)
          : std::max(step_ratio(out), m.rva * m.rvf * speed * s.steepest * table_.scan_period_s);
  out.off_ratio = off / lowest;
  if (options_.keep_speed_band && spindle_.speed_tolerance_ratio > 0.0 &&
      out.off_ratio > spindle_.speed_tolerance_ratio * (1.0 + kSame)) {
    add(out, DriveLimit::monitor,
        fmt::format("the speed is up to {:.1f} % off its set-point; beyond {:.3g} % the control "
                    "drops \"spindle in set range\" and may hold the feed",
                    100.0 * out.off_ratio, 100.0 * spindle_.speed_tolerance_ratio));
  }
}

std::optional<double> DriveLimits::most_rvf(double programmed_rev_s, Modulation modulation,
                                            double low, double high) const {
  const auto follows = [&](double rvf) {
    modulation.rvf = rvf;
    return modulated(programmed_rev_s, modulation).possible();
  };
  if (!follows(low)) {
    return std::nullopt;
  }
  if (follows(high)) {
    return high;
  }
  // Bisects on a logarithmic scale, since RVF spans decades; 40 halvings leave some 1e-11.
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (follows(middle) ? low : high) = middle;
  }
  return low;
}

const char* name(DriveLimit limit) noexcept {
  switch (limit) {
    case DriveLimit::speed:
      return "speed";
    case DriveLimit::levels:
      return "levels";
    case DriveLimit::scan:
      return "scan";
    case DriveLimit::acceleration:
      return "acceleration";
    case DriveLimit::slew:
      return "slew";
    case DriveLimit::walk:
      return "walk";
    case DriveLimit::ramp:
      return "ramp";
    case DriveLimit::power:
      return "power";
    case DriveLimit::torque:
      return "torque";
    case DriveLimit::heat:
      return "heat";
    case DriveLimit::monitor:
      return "monitor";
  }
  return "speed";
}

}  // namespace steadyrest::chatter::offline
