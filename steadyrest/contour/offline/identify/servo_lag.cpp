// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <fmt/core.h>

#include <steadyrest/contour/offline/identify/servo_lag.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kSmooth_s = 0.02;
constexpr int kMeans = 3;
constexpr std::size_t kLeastLagRows = 500;
constexpr double kLeastLag_s = 0.002;
constexpr double kMostLag_s = 1.0;
constexpr double kExplains = 0.5;  // of what the law without it leaves

/// Moving mean over `width` values: as many fewer, plus one.
std::vector<double> mean_of(const std::vector<double>& from, std::size_t width) {
  std::vector<double> out;
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sum += from[i] - (i >= width ? from[i - width] : 0.0);
    if (i + 1 >= width) {
      out.push_back(sum / static_cast<double>(width));
    }
  }
  return out;
}

std::vector<double> smoothed(const std::vector<double>& from, const ServoRun& run, std::size_t back,
                             std::size_t width) {
  const auto at = [&](std::size_t i) { return from.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<double> out(at(run.first - back), at(run.last - back));
  for (int i = 0; i < kMeans; ++i) {
    out = mean_of(out, width);
  }
  return out;
}

/// Sums for x' over e, c', 1 and −x".
struct LagSums {
  Eigen::Matrix4d left = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double square = 0.0;
  std::size_t rows = 0;

  void add(const Eigen::Vector4d& row, double speed) {
    left += row * row.transpose();
    right += row * speed;
    square += speed * speed;
    ++rows;
  }
};

}  // namespace

std::optional<ServoLag> velocity_lag(const ServoLog& log, std::span<const ServoRun> runs,
                                     double period_s, int shift) {
  const auto back = static_cast<std::size_t>(shift);
  const auto width = static_cast<std::size_t>(std::max(3L, std::lround(kSmooth_s / period_s)));
  LagSums sums;
  for (const ServoRun& run : runs) {
    const ServoRun whole{std::max(run.first, back), run.last};
    if (whole.last < whole.first + kMeans * width + 2) {
      continue;
    }
    const auto c = smoothed(log.command, whole, back, width);
    const auto x = smoothed(log.actual, whole, 0, width);
    for (std::size_t n = 1; n + 1 < x.size(); ++n) {
      const double speed = (x[n + 1] - x[n - 1]) / (2.0 * period_s);
      const double bend = (x[n + 1] - 2.0 * x[n] + x[n - 1]) / (period_s * period_s);
      const double asked = (c[n + 1] - c[n - 1]) / (2.0 * period_s);
      sums.add({c[n] - x[n], asked, 1.0, -bend}, speed);
    }
  }
  const Eigen::LDLT<Eigen::Matrix4d> with(sums.left);
  const Eigen::LDLT<Eigen::Matrix3d> without(sums.left.topLeftCorner<3, 3>());
  if (sums.rows < kLeastLagRows || with.info() != Eigen::Success ||
      without.info() != Eigen::Success) {
    return std::nullopt;
  }
  const Eigen::Vector4d found = with.solve(sums.right);
  const Eigen::Vector3d plain = without.solve(sums.right.head<3>());
  const double left = std::max(0.0, sums.square - found.dot(sums.right));
  const double plainly = std::max(1e-300, sums.square - plain.dot(sums.right.head<3>()));
  const ServoLag out{found[3], found[0]};
  const bool lags = out.lag_s >= kLeastLag_s && out.lag_s <= kMostLag_s && out.gain_1_s > 0.0;
  return lags && std::sqrt(left / plainly) <= kExplains ? std::optional(out) : std::nullopt;
}

std::string in_words(const ServoLag& lag) {
  return fmt::format(
      "its velocity loop lags by about {:.2g} ms (gain about {:.2g} 1/s); the law "
      "fitted here has no such lag",
      1e3 * lag.lag_s, lag.gain_1_s);
}

std::string to_check(const ServoLog& log, std::span<const ServoRun> runs, double period_s) {
  double behind = 0.0;
  double square = 1e-300;
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first; n + 1 < run.last; ++n) {
      const double speed = (log.command[n + 1] - log.command[n]) / period_s;
      behind += (log.command[n] - log.actual[n]) * speed;
      square += speed * speed;
    }
  }
  const double lag_ms = 1e3 * behind / square;
  return lag_ms < 0.0 ? fmt::format(
                            "the actual position leads the command by {:.3g} ms: check that "
                            "they are not swapped, and belong to the same axis",
                            -lag_ms)
                      : fmt::format(
                            "the actual position is {:.3g} ms behind the command: check "
                            "that both belong to this axis, and that nothing but the "
                            "control moves it",
                            lag_ms);
}

}  // namespace steadyrest::contour::offline
