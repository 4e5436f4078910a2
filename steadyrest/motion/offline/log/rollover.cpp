// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/offline/log/rollover.hpp>

namespace steadyrest::motion::offline {
namespace {

constexpr int kCounters[] = {16, 24, 32};
constexpr double kContinues = 0.5;
constexpr double kFew = 64.0;  // counts that an axis may gain in a row

bool in_counter(std::int64_t a, std::int64_t b, int bits) {
  const std::int64_t turn = std::int64_t{1} << bits;
  const auto [least, most] = std::minmax(a, b);
  return (least >= 0 && most < turn) || (least >= -turn / 2 && most < turn / 2);
}

}  // namespace

/// The step less a turn, if that is what the axis did.
std::optional<std::int64_t> Rollover::turned(double t_s, std::int64_t count, int bits) const {
  const std::int64_t turn = std::int64_t{1} << bits;
  const std::int64_t step = count - count_;
  const std::int64_t rest = step > 0 ? step - turn : step + turn;
  if (std::abs(step) <= turn / 2 || std::abs(rest) >= turn / 8 ||
      !in_counter(count, count_, bits)) {
    return std::nullopt;
  }
  const double due = step_s_ > 0.0 ? step_ * (t_s - t_s_) / step_s_ : 0.0;
  const auto off = static_cast<double>(rest);
  const bool continues =
      std::abs(off - due) <= kContinues * std::max(std::abs(off), std::abs(due)) + kFew;
  return continues ? std::optional(rest) : std::nullopt;
}

std::int64_t Rollover::unwrapped(double t_s, std::int64_t count) {
  if (!started_) {
    started_ = true;
    t_s_ = t_s;
    count_ = count;
    return count;
  }
  std::int64_t step = count - count_;
  for (const int bits : kCounters) {
    const auto rest =
        bits_ == 0 || bits_ == bits ? turned(t_s, count, bits) : std::optional<std::int64_t>();
    if (rest) {
      bits_ = bits;
      ++times_;
      offset_ += *rest - step;
      step = *rest;
      break;
    }
  }
  step_ = static_cast<double>(step);
  step_s_ = t_s - t_s_;
  t_s_ = t_s;
  count_ = count;
  return count + offset_;
}

}  // namespace steadyrest::motion::offline
