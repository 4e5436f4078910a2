// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_run.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kHardShare = 0.5;  // of the largest commanded acceleration
constexpr double kHardLags = 3.0;   // time constants that its error lasts

struct OffSums {
  double squares = 0.0;
  std::size_t count = 0;

  void add(double value) {
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double rms() const {
    return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
  }
};

/// What an axis loses at a reversal: the law's residuals of the time constant behind it, in the new
/// direction.
class Reversals {
 public:
  explicit Reversals(const ServoStep& step)
      : window_(std::max<std::size_t>(
            3, static_cast<std::size_t>(std::lround(-1.0 / std::log(step.p))))) {}

  void begin() { direction_ = 0.0, left_ = 0; }
  void add(double residual, double d) {
    const double now = d > 0.0 ? 1.0 : d < 0.0 ? -1.0 : direction_;
    if (now != direction_) {
      // One that is cut short by the next says nothing.
      left_ = direction_ == 0.0 ? 0 : window_;
      sum_ = 0.0;
      direction_ = now;
    }
    if (left_ > 0) {
      sum_ += residual * direction_;
      if (--left_ == 0) {
        lost_.push_back(sum_);
      }
    }
  }
  void put(ServoMisfit& out) const {
    const auto n = static_cast<double>(lost_.size());
    out.reversals = lost_.size();
    for (const double one : lost_) {
      out.lost_motion += one / n;
    }
    double squares = 0.0;
    for (const double one : lost_) {
      squares += (one - out.lost_motion) * (one - out.lost_motion);
    }
    out.lost_motion_sd = lost_.size() < 2 ? 0.0 : std::sqrt(squares / (n - 1.0) / n);
  }

 private:
  std::size_t window_;
  std::size_t left_ = 0;
  double direction_ = 0.0;
  double sum_ = 0.0;
  std::vector<double> lost_;
};

double hardest(const ServoLog& log, std::span<const ServoRun> runs) {
  double most = 0.0;
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first + 1; n < run.last; ++n) {
      most =
          std::max(most, std::abs(log.command[n + 1] - 2.0 * log.command[n] + log.command[n - 1]));
    }
  }
  return most;
}

}  // namespace

ServoMisfit misfit(const ServoLog& log, std::span<const ServoRun> runs, int shift,
                   const ServoStep& step) {
  const auto s = static_cast<std::size_t>(shift);
  const double hard = kHardShare * hardest(log, runs);
  const auto lasts = static_cast<std::size_t>(std::ceil(-kHardLags / std::log(step.p)));
  OffSums all;
  OffSums in_hard;
  OffSums in_calm;
  Reversals reversals(step);
  ServoMisfit out;
  for (const ServoRun& run : runs) {
    if (run.first + s >= run.last) {
      continue;
    }
    double simulated = log.command[run.first] - log.actual[run.first + s];
    double before = 0.0;
    std::size_t hard_left = 0;
    reversals.begin();
    for (std::size_t n = run.first + s; n < run.last; ++n) {
      const double d = log.command[n + 1 - s] - log.command[n - s];
      const double e = log.command[n - s] - log.actual[n];
      const double next = log.command[n + 1 - s] - log.actual[n + 1];
      reversals.add(next - step.p * e - step.q * d - step.r, d);
      simulated = step.p * simulated + step.q * d + step.r;
      const double off = simulated - next;
      all.add(off);
      out.largest = std::max(out.largest, std::abs(off));
      hard_left = hard > 0.0 && std::abs(d - before) >= hard ? lasts : hard_left;
      (hard_left > 0 ? in_hard : in_calm).add(off);
      hard_left -= hard_left > 0 ? 1 : 0;
      before = d;
    }
  }
  out.rms = all.rms();
  out.hard_rms = in_hard.rms();
  out.calm_rms = in_calm.rms();
  reversals.put(out);
  return out;
}

}  // namespace steadyrest::contour::offline
