// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_runs.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kSameStep = 0.1;      // of the period
constexpr double kMovesShare = 1e-3;   // of the largest step: less is rest
constexpr double kTail_s = 0.1;        // after motion: the lag runs out
constexpr std::size_t kLeastRun = 20;  // samples of a stretch

}  // namespace

double servo_period_s(const std::vector<double>& time_s) {
  if (time_s.size() < 2) {
    return 0.0;
  }
  std::vector<double> step(time_s.size() - 1);
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] = time_s[i + 1] - time_s[i];
  }
  const auto middle = step.begin() + static_cast<std::ptrdiff_t>(step.size() / 2);
  std::ranges::nth_element(step, middle);
  return *middle;
}

std::vector<ServoRun> unbroken(const ServoLog& log, double period_s, double most_s) {
  std::vector<ServoRun> out;
  for (std::size_t n = 0; n < log.time_s.size(); ++n) {
    const bool joins =
        n > 0 && std::abs(log.time_s[n] - log.time_s[n - 1] - period_s) <= kSameStep * period_s &&
        std::abs(log.command[n] - log.command[n - 1]) <= most_s * period_s;
    if (joins) {
      out.back().last = n;
    } else {
      out.push_back({n, n});
    }
  }
  return out;
}

std::vector<ServoRun> in_motion(const ServoLog& log, std::span<const ServoRun> runs,
                                double period_s) {
  double largest = 0.0;
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first; n < run.last; ++n) {
      largest = std::max(largest, std::abs(log.command[n + 1] - log.command[n]));
    }
  }
  const auto tail = static_cast<std::size_t>(std::ceil(kTail_s / period_s));
  std::vector<ServoRun> out;
  const auto keep = [&out](std::size_t first, std::size_t last) {
    if (last >= first + kLeastRun) {
      out.push_back({first, last});
    }
  };
  for (const ServoRun& run : runs) {
    std::optional<ServoRun> moving;
    for (std::size_t n = run.first; n < run.last; ++n) {
      if (largest == 0.0 ||
          std::abs(log.command[n + 1] - log.command[n]) <= kMovesShare * largest) {
        continue;
      }
      if (moving && n > moving->last) {
        keep(moving->first, moving->last);
        moving.reset();
      }
      moving = {moving ? moving->first : n, std::min(n + 1 + tail, run.last)};
    }
    if (moving) {
      keep(moving->first, moving->last);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
