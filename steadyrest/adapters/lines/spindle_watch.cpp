// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/adapters/lines/spindle_watch.hpp>

namespace steadyrest::adapters::lines {
namespace {

constexpr double kWindow_s = 0.2;
constexpr double kSettled_s = 1.0;
constexpr double kSteady = 0.02;
constexpr double kSameRatio = 1e-9;

}  // namespace

void SpindleWatch::update(double time_s, double count, double ratio) noexcept {
  if (!started_ || time_s < last_s_) {
    started_ = true;
    from_s_ = last_s_ = ratio_since_s_ = time_s;
    from_count_ = last_count_ = count;
    ratio_ = ratio;
    return;
  }
  if (std::abs(ratio - ratio_) > kSameRatio) {
    ratio_ = ratio;
    ratio_since_s_ = time_s;
  }
  if (time_s > last_s_) {
    actual_rev_s_ = (count - last_count_) / (counts_rev_ * (time_s - last_s_));
  }
  last_s_ = time_s;
  last_count_ = count;
  if (time_s - from_s_ < kWindow_s) {
    return;
  }
  const double speed = (count - from_count_) / (counts_rev_ * (time_s - from_s_));
  const bool steady = std::abs(speed - measured_rev_s_) <= kSteady * std::abs(speed);
  if (steady && ratio_ > 0.0 && time_s - ratio_since_s_ >= kSettled_s) {
    programmed_rev_s_ = speed / ratio_;
  }
  measured_rev_s_ = speed;
  from_s_ = time_s;
  from_count_ = count;
}

}  // namespace steadyrest::adapters::lines
