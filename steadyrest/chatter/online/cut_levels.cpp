// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/chatter/online/cut_levels.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kFreeLearnS = 0.5;
constexpr double kFreeRiseS = 0.13;
constexpr double kFreeFallS = 30.0;
constexpr double kFloorRiseS = 0.5;
constexpr double kFloorFallS = 2.0;

}  // namespace

void CutLevels::learn(const Seen& seen, double hop_s) noexcept {
  const double rise = seen.free_ratio - free_ratio_;
  const double free_s = rise > 0.0 ? kFreeRiseS : kFreeFallS;
  free_ratio_ += judged_s_ > kFreeLearnS ? std::min(hop_s / free_s, 1.0) * rise : 0.0;
  if (seen.suspect) {
    return;
  }
  const auto follow = [&](double& level, double energy) {
    const double memory_s = energy > level ? kFloorRiseS : kFloorFallS;
    // The first judgements are averaged with equal weight.
    const double weight = std::max(hop_s / memory_s, hop_s / std::max(judged_s_, hop_s));
    level += std::min(weight, 1.0) * (energy - level);
  };
  follow(line_energy_, seen.line_energy);
  follow(all_energy_, seen.all_energy);
}

}  // namespace steadyrest::chatter::online
