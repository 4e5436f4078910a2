// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/chatter/offline/depth/crossing.hpp>
#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::units::kTurn;

constexpr double kTolerance = 1e-10;  ///< of the multipliers

/// The decay of the most persistent free vibration. At depth 0 only the modes' own damping counts:
/// ln ρ = −ζω·T of that mode.
double least_decay_1_s(const Process& process) {
  double least = process.modes[0].damping_ratio * process.modes[0].frequency_hz;
  for (const Mode& mode : process.modes) {
    least = std::min(least, mode.damping_ratio * mode.frequency_hz);
  }
  return kTurn * least;
}

}  // namespace

Result<DepthLine> DepthLine::make(const Process& process, double speed_rev_s,
                                  const Modulation& modulation, double most_depth_mm) {
  if (process.modes.empty()) {
    return refuse("the process has no mode", "give at least one vibration mode");
  }
  if (!(speed_rev_s > 0.0) || !std::isfinite(speed_rev_s)) {
    return refuse(fmt::format("speed {} rev/s; allowed: above 0", speed_rev_s),
                  "give a speed above 0");
  }
  if (!(most_depth_mm > 0.0) || !std::isfinite(most_depth_mm)) {
    return refuse(fmt::format("depth {} mm; allowed: above 0", most_depth_mm),
                  "give a depth above 0");
  }
  const bool constant = SpeedProfile(speed_rev_s, modulation).constant();
  if (!constant && !(modulation.rva >= 0.0 && modulation.rva < 1.0 && modulation.rvf > 0.0)) {
    return refuse(fmt::format("RVA {}, RVF {}; allowed: RVA 0 to below 1, RVF above 0",
                              modulation.rva, modulation.rvf),
                  "give both within their ranges");
  }
  DepthLine out;
  out.process_ = process;
  out.config_.speed_rev_s = speed_rev_s;
  out.config_.modulation = modulation;
  out.config_.most_depth_mm = most_depth_mm;
  const double decay = least_decay_1_s(process);
  const bool straight =
      process.tool.helix_rad == 0.0 || process.cut.operation == Operation::turning;
  // DelayCycle checks its own reach; the tracker does not, so check it here.
  if (constant) {
    if (auto refused = beyond_reach(process, speed_rev_s, most_depth_mm)) {
      return std::unexpected(std::move(*refused));
    }
  }
  // With helix and several modes each depth needs new matrices, and the tracker gains nothing.
  if (constant && PassMatrix::simple(process) && (straight || process.modes.size() == 1)) {
    out.tracker_ = std::make_unique<DepthTracker>(process, speed_rev_s, most_depth_mm);
    out.free_log_radius_ = -decay / (speed_rev_s * static_cast<double>(process.tool.teeth));
    return out;
  }
  auto cycle = DelayCycle::make(process, out.config_);
  if (!cycle) {
    return std::unexpected(cycle.error());
  }
  out.free_log_radius_ = -decay * cycle->period_s() / static_cast<double>(cycle->law_periods());
  // A product with the map touches each number of the state once per pass.
  out.work_ = static_cast<std::size_t>(cycle->state_size()) * cycle->passes();
  // Straight teeth: the depth only scales the forces, so one cycle serves all depths.
  if (straight) {
    out.cycle_ = std::make_unique<DelayCycle>(std::move(*cycle));
  }
  return out;
}

double DepthLine::log_radius(double depth_mm) {
  if (depth_mm <= 0.0) {
    return free_log_radius_;
  }
  if (tracker_) {
    return std::log(std::abs(tracker_->dominant(depth_mm)));
  }
  const auto of = [](DelayCycle& cycle, double depth) {
    cycle.set_depth(depth);
    return multipliers(cycle, 1, kTolerance).log_modulus[0] /
           static_cast<double>(cycle.law_periods());
  };
  if (cycle_) {
    return of(*cycle_, depth_mm);
  }
  DelayCycle::Config config = config_;
  config.most_depth_mm = depth_mm;
  // make() accepts at every smaller depth what it accepts at the greatest.
  auto cycle = DelayCycle::make(process_, config).value();
  return of(cycle, depth_mm);
}

double DepthLine::crossing_mm(double stable_mm, double log_stable, double unstable_mm,
                              double log_unstable) {
  return crossing([this](double depth_mm) { return log_radius(depth_mm); }, {stable_mm, log_stable},
                  {unstable_mm, log_unstable});
}

}  // namespace steadyrest::chatter::offline
