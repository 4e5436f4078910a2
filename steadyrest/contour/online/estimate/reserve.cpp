// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/estimate/reserve.hpp>

namespace steadyrest::contour::online {

double Reserve::update(const Input& input) noexcept {
  const double largest_mm = std::max(input.seen_mm, input.modelled_mm);
  if (input.cancelled || largest_mm >= kCounts * config_.limit_mm) {
    const double excess = std::max(0.0, input.seen_mm - input.modelled_mm);
    const double share = std::min(1.0, input.step_s / kMemoryS);
    state_.excess_mm2 += share * (2.0 * excess * excess - state_.excess_mm2);
  }
  return limit_mm();
}

double Reserve::limit_mm() const noexcept {
  const double counting_mm2 = config_.count_mm * config_.count_mm / 12.0;
  const double model_mm = kSigmas * std::sqrt(std::max(0.0, state_.excess_mm2 - counting_mm2));
  const double doubt_mm = std::hypot(model_mm, kDoubt * config_.half_backlash_mm);
  const double margin_mm = config_.margin * config_.limit_mm;
  const double reserve_mm = std::clamp(doubt_mm - margin_mm, 0.0, kMost * config_.limit_mm);
  return config_.limit_mm - margin_mm - reserve_mm;
}

}  // namespace steadyrest::contour::online
