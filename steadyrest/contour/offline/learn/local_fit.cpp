// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/contour/offline/learn/local_fit.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;

constexpr double kReach = 4.0;  ///< σ

struct Sums {
  double w = 0.0;
  double wt = 0.0;
  double wtt = 0.0;
  kernel::signal::Point wv{};
  kernel::signal::Point wtv{};

  void add(double weight, double t, const kernel::signal::Point& value) noexcept {
    w += weight;
    wt += weight * t;
    wtt += weight * t * t;
    wv = geometry::add_scaled(wv, value, weight);
    wtv = geometry::add_scaled(wtv, value, weight * t);
  }
};

}  // namespace

LocalLine local_line(std::span<const double> time_s, std::span<const kernel::signal::Point> value,
                     std::size_t j, double sigma_s) noexcept {
  Sums sums;
  const auto take = [&](std::size_t i) {
    const double t = (time_s[i] - time_s[j]) / sigma_s;
    if (std::abs(t) > kReach) {
      return false;
    }
    sums.add(std::exp(-0.5 * t * t), t, value[i]);
    return true;
  };
  std::size_t after = j;
  while (after < time_s.size() && take(after)) {
    ++after;
  }
  std::size_t before = j;
  while (before > 0 && take(before - 1)) {
    --before;
  }
  const double determinant = sums.w * sums.wtt - sums.wt * sums.wt;
  LocalLine out;
  for (std::size_t axis = 0; axis < out.value.size(); ++axis) {
    if (determinant <= 1e-12 * sums.w * sums.w) {
      out.value[axis] = sums.wv[axis] / sums.w;
      continue;
    }
    out.value[axis] = (sums.wtt * sums.wv[axis] - sums.wt * sums.wtv[axis]) / determinant;
    out.slope_1_s[axis] =
        (sums.w * sums.wtv[axis] - sums.wt * sums.wv[axis]) / (determinant * sigma_s);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
