// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/plan/same.hpp>
#include <steadyrest/chatter/offline/plan/speed_table_of.hpp>

namespace steadyrest::chatter::offline {

online::SpeedTable::Config steps_of(const kernel::machine::Machine& machine) {
  online::SpeedTable::Config config;
  for (const double ratio : machine.spindle_override.ratio) {
    config.step_ratio.push_back(std::min(ratio, machine.spindle_override.max_ratio));
  }
  config.min_ratio = machine.envelope.min_spindle_ratio;
  config.max_ratio = machine.envelope.max_spindle_ratio;
  config.min_rev_s = machine.spindle.min_rev_s;
  config.max_rev_s = machine.spindle.max_rev_s;
  return config;
}

kernel::outcome::Result<void> add_depths(const Process& process,
                                         const std::vector<double>& programmed_rev_s,
                                         double most_depth_mm, online::SpeedTable::Config& config) {
  std::vector<double> speeds;
  // The border only at speeds that the override can write: the online table picks steps, so depths
  // in between would never be read.
  for (const double programmed : programmed_rev_s) {
    for (const double ratio : config.step_ratio) {
      const double speed = ratio * programmed;
      if (speed > 0.0 && speed >= config.min_rev_s && speed <= config.max_rev_s) {
        speeds.push_back(speed);
      }
    }
  }
  std::ranges::sort(speeds);
  for (const double speed : speeds) {
    // Steps of different programmed speeds may coincide; the table requires rising speeds.
    if (!config.speed_rev_s.empty() && speed <= config.speed_rev_s.back() * (1.0 + kSame)) {
      continue;
    }
    const auto limit = limit_depth_mm(process, speed, {}, most_depth_mm);
    if (!limit) {
      return std::unexpected(limit.error());
    }
    config.speed_rev_s.push_back(speed);
    // Stable as far as searched: the table cannot express more.
    config.limit_depth_mm.push_back(limit->value_or(most_depth_mm));
  }
  return {};
}

}  // namespace steadyrest::chatter::offline
