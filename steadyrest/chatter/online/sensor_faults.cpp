// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/sensor_faults.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kNoChance = 11.5;      // −ln of 1e-5
constexpr double kRepeatMemory = 1e-3;  // of a sample
constexpr double kFirst = 10.0;         // samples; then a plain mean until the memory is full
constexpr double kClippedMemoryS = 1.0;

}  // namespace

bool SensorFaults::update(double value) noexcept {
  if (!std::isfinite(value)) {
    return true;
  }
  const bool same = value == last_;
  last_ = value;
  repeats_ = same ? repeats_ + 1 : 0;
  const bool gap = static_cast<double>(repeats_) * -std::log(repeat_share_) > kNoChance;
  rail_ = std::max(rail_, std::abs(value));
  const bool clipped = same && std::abs(value) >= rail_;
  clipped_share_ += ((clipped ? 1.0 : 0.0) - clipped_share_) / (kClippedMemoryS * rate_hz_);
  if (!gap) {
    seen_ += 1.0;
    repeat_share_ += std::max(kRepeatMemory, 1.0 / (kFirst + seen_)) *
                     ((same ? 1.0 : kLeastRepeats) - repeat_share_);
  }
  return gap;
}

}  // namespace steadyrest::chatter::online
