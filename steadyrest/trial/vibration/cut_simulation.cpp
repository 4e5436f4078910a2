// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

// The process file's cut over time. Shares only the file with the chatter room's solver, so that
// the two can check each other.
namespace steadyrest::trial::vibration {
namespace {

using chatter::offline::Direction;
using chatter::offline::Operation;
using chatter::offline::Process;
using chatter::offline::SpeedProfile;
using kernel::units::kTurn;
using sim::CuttingProcess;

constexpr double kDisturbance_mm = 1e-3;
constexpr double kLeastBlock = 8.0;   ///< pitches in one mean
constexpr double kLeastBlocks = 8.0;  ///< half of them are measured
constexpr double kMostSteps = 1e7;    ///< of all blocks, unless the least number needs more

// The grid is made for the law's slowest speed.
double slowest_rev_s(const CutSettings& settings) {
  return settings.speed_rev_s * (settings.modulation.law == chatter::online::Law::constant
                                     ? 1.0
                                     : 1.0 - settings.modulation.rva);
}

/// Slope of the least-squares line through the values at 0, 1, 2 …
/// With k from −(n − 1)/2 on: Σk² = n(n² − 1)/12.
double slope(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double products = 0.0;
  double k = 0.5 * (1.0 - n);
  for (const double value : values) {
    products += k * value;
    k += 1.0;
  }
  return 12.0 * products / (n * (n * n - 1.0));
}

}  // namespace

// The border between room and simulation: values are copied, no type is shared.
sim::Cutting cutting_of(const Process& process, double depth_mm) {
  sim::Cutting out;
  for (const chatter::offline::Mode& mode : process.modes) {
    out.modes.push_back({.shape = mode.shape,
                         .frequency_hz = mode.frequency_hz,
                         .damping_ratio = mode.damping_ratio,
                         .mass_kg = mode.mass_kg});
  }
  out.turning = process.cut.operation == Operation::turning;
  out.teeth = process.tool.teeth;
  out.diameter_mm = process.tool.diameter_mm;
  out.helix_rad = process.tool.helix_rad;
  out.pitch_rad = process.tool.pitch_rad;
  out.runout_mm = process.tool.runout_mm;
  out.entry_rad = process.entry_rad();
  out.exit_rad = process.exit_rad();
  out.wall_rad = process.cut.direction == Direction::down ? std::numbers::pi : 0.0;
  out.depth_mm = depth_mm;
  out.tangential_n_mm2 = process.cut.tangential_n_mm2;
  out.radial_n_mm2 = process.cut.radial_n_mm2;
  out.edge_tangential_n_mm = process.cut.edge_tangential_n_mm;
  out.edge_radial_n_mm = process.cut.edge_radial_n_mm;
  out.process_damping_n_mm = process.cut.process_damping_n_mm;
  return out;
}

// Growth is measured, not assumed: the slope of ln(size), averaged over whole periods of the law,
// against the number of teeth.
kernel::outcome::Result<double> log_growth_per_tooth(const Process& process,
                                                     const CutSettings& settings,
                                                     std::size_t pitches) {
  CuttingProcess::Config config{.cut = cutting_of(process, settings.depth_mm),
                                .slowest_rev_s = slowest_rev_s(settings),
                                .steps_per_period = settings.steps_per_period,
                                .keeps_contact = true};
  // Runout and edge forces cause forced vibration; they do not change its growth.
  config.cut.runout_mm.clear();
  config.cut.edge_radial_n_mm = 0.0;
  config.cut.edge_tangential_n_mm = 0.0;
  auto cut = CuttingProcess::make(config);
  if (!cut) {
    return std::unexpected(cut.error());
  }
  const SpeedProfile speed(settings.speed_rev_s, settings.modulation);
  const auto teeth = static_cast<double>(process.tool.teeth);
  const double step_rad = kTurn / static_cast<double>(cut->steps());
  // A block is one period of the law, or some turns.
  const double block_rad =
      speed.constant() ? kTurn * std::ceil(kLeastBlock / teeth) : speed.period_rad();
  // Whole blocks, at least eight: a slope through fewer points would be a guess.
  const double wanted_rad =
      std::min(static_cast<double>(pitches) * kTurn / teeth, kMostSteps * step_rad);
  const double blocks = std::max(kLeastBlocks, std::ceil(wanted_rad / block_rad));
  cut->step({.speed_rev_s = speed.speed_rad_s(0.0) / kTurn});
  cut->disturb(kDisturbance_mm);
  std::vector<double> log_size;
  double scaled = 0.0;
  double angle = step_rad;
  for (double block = 1.0; block <= blocks; block += 1.0) {
    double sum = 0.0;
    double count = 0.0;
    double square = 0.0;
    std::size_t steps = 0;
    for (; angle < block * block_rad; angle += step_rad) {
      const auto now =
          cut->step({.speed_rev_s = speed.speed_rad_s(angle + 0.5 * step_rad) / kTurn});
      square += now.displacement_mm[0] * now.displacement_mm[0] +
                now.displacement_mm[1] * now.displacement_mm[1];
      if (++steps == cut->steps() / process.tool.teeth) {
        // Mean of the logarithm over the block, pitch by pitch: swings within it cancel.
        const double size = std::max(std::sqrt(square), 1e-300);
        sum += scaled + std::log(size);
        count += 1.0;
        steps = 0;
        square = 0.0;
        if (size < 1e-30 || size > 1e30) {
          // Keeps it within a double over any number of turns.
          cut->scale(kDisturbance_mm / size);
          scaled += std::log(size / kDisturbance_mm);
        }
      }
    }
    // The first half is for the start to die away.
    if (2.0 * block > blocks && count > 0.0) {
      log_size.push_back(sum / count);
    }
  }
  return slope(log_size) / (block_rad / kTurn * teeth);
}

// The full process: the tool may leave the cut, runout and edge forces included.
kernel::outcome::Result<void> simulate(const Process& process, const CutSettings& settings,
                                       double seconds,
                                       const std::function<void(const Moment&)>& sink) {
  auto cut = CuttingProcess::make({.cut = cutting_of(process, settings.depth_mm),
                                   .slowest_rev_s = slowest_rev_s(settings),
                                   .steps_per_period = settings.steps_per_period});
  if (!cut) {
    return std::unexpected(cut.error());
  }
  const SpeedProfile speed(settings.speed_rev_s, settings.modulation);
  // The speed of a step is that of its middle: second order.
  const double half_rad = 0.5 * kTurn / static_cast<double>(cut->steps());
  Moment now;
  while (now.t_s < seconds) {
    now.speed_rev_s = speed.speed_rad_s(now.angle_rad + half_rad) / kTurn;
    now.cut = cut->step(
        {.speed_rev_s = now.speed_rev_s, .feed_per_tooth_mm = process.cut.feed_per_tooth_mm});
    now.angle_rad = cut->angle_rad();
    now.t_s += now.cut.period_s;
    sink(now);
  }
  return {};
}

}  // namespace steadyrest::trial::vibration
