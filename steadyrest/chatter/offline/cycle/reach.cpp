// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// The work grows with the waves in the period: nodes in proportion, matrices with the square. Each
// bound below turns a cost or a loss of digits into a limit that a machinist can check, and the
// out_of_reach refusal says which speed and depth would be accepted.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::units::kTurn;

// These catch a figure in the process file that is a million times off before it costs minutes and
// gigabytes. Real cuts are well inside.
constexpr double kMostWaves = 300.0;    ///< between two teeth
constexpr double kMostDamped = 1000.0;  ///< likewise, including the rate of process damping
constexpr double kLeastWaves = 1e-4;    ///< of the slowest mode, likewise
constexpr double kMostInPeriod = 3e4;   ///< waves in the principal period: some 1 GB
constexpr double kMostWinding = 16.0;   ///< turns of a helical edge round the tool
constexpr double kMostDepth_mm = 1e5;   ///< more than any machine
constexpr int kHalvings = 80;

constexpr const char* kCheck =
    "give what the machine really does, and check frequency_hz, mass_kg or stiffness_N_um and the "
    "coefficients in the process file";

double passes_per_rev(const Process& process) noexcept {
  return process.even_pitch() ? static_cast<double>(process.tool.teeth) : 1.0;
}

// Turns of the edge's helix over the depth of cut.
double winding(const Process& process, double depth_mm) noexcept {
  return process.cut.operation == Operation::turning
             ? 0.0
             : depth_mm * std::tan(process.tool.helix_rad) /
                   (std::numbers::pi * process.tool.diameter_mm);
}

/// Where `fits` changes from true to false between two numbers above 0, on their geometric scale.
template <class Fits>
double last_fit(double fits_at, double fails_at, const Fits& fits) {
  for (int i = 0; i < kHalvings; ++i) {
    // The range spans up to 24 decades, so bisect its logarithm. Two roots, not the root of the
    // product, which may overflow.
    const double middle = std::sqrt(fits_at) * std::sqrt(fails_at);
    (fits(middle) ? fits_at : fails_at) = middle;
  }
  return fits_at;
}

/// `at this depth from 95 rpm on, at this speed up to 0.3 mm`.
template <class Fits>
std::string allowed(double speed_rev_s, double depth_mm, const Fits& fits) {
  constexpr double kFar = 1e12;
  std::string out;
  // A faster spindle and a smaller depth both mean fewer waves. Each is named if it suffices alone.
  if (fits(speed_rev_s * kFar, depth_mm)) {
    const double least = last_fit(speed_rev_s * kFar, speed_rev_s,
                                  [&](double speed) { return fits(speed, depth_mm); });
    // Rounded to the safe side, so that the named speed is accepted when typed in.
    out = fmt::format("at this depth from {:.4g} rpm on", 60.0 * least * 1.0001);
  }
  if (fits(speed_rev_s, depth_mm / kFar)) {
    const double most =
        last_fit(depth_mm / kFar, depth_mm, [&](double depth) { return fits(speed_rev_s, depth); });
    out += fmt::format("{}at this speed up to {:.4g} mm", out.empty() ? "" : ", ", most * 0.9999);
  }
  return out.empty() ? "a faster spindle and a smaller depth" : out;
}

}  // namespace

double fastest_waves(const Process& process, double slowest_rev_s, double depth_mm) {
  return fastest_rad_s(process, depth_mm, slowest_rev_s) /
         (kTurn * slowest_rev_s * passes_per_rev(process));
}

double free_waves(const Process& process, double speed_rev_s) noexcept {
  double highest_hz = 0.0;
  for (const Mode& mode : process.modes) {
    highest_hz = std::max(highest_hz, mode.frequency_hz);
  }
  return highest_hz / (speed_rev_s * passes_per_rev(process));
}

std::optional<Refusal> beyond_reach(const Process& process, double slowest_rev_s,
                                    double most_depth_mm, std::size_t passes) {
  if (!(slowest_rev_s > 0.0) || !std::isfinite(slowest_rev_s)) {
    return bad_input(fmt::format("speed {} rpm; allowed: above 0", 60.0 * slowest_rev_s),
                     "give a speed above 0");
  }
  if (!(most_depth_mm >= 0.0 && most_depth_mm <= kMostDepth_mm)) {
    return bad_input(
        fmt::format("depth {:.6g} mm; allowed: up to {:g} mm", most_depth_mm, kMostDepth_mm),
        "give the axial depth of cut in mm");
  }
  if (const double turns = winding(process, most_depth_mm); turns > kMostWinding) {
    return bad_input(
        fmt::format("at a depth of {:.6g} mm a helical edge winds {:.4g} times around the tool; "
                    "allowed: {:g} turns, {:.4g} mm",
                    most_depth_mm, turns, kMostWinding, most_depth_mm * kMostWinding / turns),
        "give a smaller depth, or check diameter_mm and helix_deg of [tool]");
  }
  // Process damping adds a rate of decay, not an oscillation; it has a wider bound.
  Process undamped = process;
  undamped.cut.process_damping_n_mm = 0.0;
  const double in_period = kMostInPeriod / static_cast<double>(passes);
  const double most = std::min(kMostWaves, in_period);
  const auto fits = [&](double speed_rev_s, double depth_mm) {
    return fastest_waves(undamped, speed_rev_s, depth_mm) <= most &&
           fastest_waves(process, speed_rev_s, depth_mm) <= std::min(kMostDamped, in_period);
  };
  if (!fits(slowest_rev_s, most_depth_mm)) {
    return bad_input(
        fmt::format("at {:.6g} rpm and {:.6g} mm the fastest vibration makes {:.4g} waves between "
                    "two teeth; the solver follows {:.4g}{}: {}",
                    60.0 * slowest_rev_s, most_depth_mm,
                    fastest_waves(process, slowest_rev_s, most_depth_mm), most,
                    passes > 1 ? fmt::format(" over the law's {} passes", passes) : "",
                    allowed(slowest_rev_s, most_depth_mm, fits)),
        kCheck);
  }
  // An upper bound on the speed: beyond it the multipliers merely converge on 1, where ln ρ loses
  // its digits.
  double lowest_hz = process.modes.empty() ? 0.0 : process.modes[0].frequency_hz;
  for (const Mode& mode : process.modes) {
    lowest_hz = std::min(lowest_hz, mode.frequency_hz);
  }
  const double most_rev_s = lowest_hz / (kLeastWaves * passes_per_rev(process));
  if (slowest_rev_s > most_rev_s && !process.modes.empty()) {
    return bad_input(
        fmt::format("at {:.6g} rpm the mode of {:.4g} Hz makes less than {:g} of a wave "
                    "between two teeth; allowed: up to {:.4g} rpm",
                    60.0 * slowest_rev_s, lowest_hz, kLeastWaves, 60.0 * most_rev_s),
        kCheck);
  }
  return std::nullopt;
}

}  // namespace steadyrest::chatter::offline
