// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

/// A point that runs along a path, and the estimator of its error.
namespace steadyrest::contour::online::test {

namespace geometry = math::geometry;
using kernel::signal::PathView;

/// A point that runs along a path at constant speed, and an ideal first-order servo behind it.
class Runner {
 public:
  Runner(PathView path, double speed_mm_s, double gain_1_s, double period_s)
      : path_(path), speed_(speed_mm_s), gain_(gain_1_s), period_(period_s) {
    actual_ = path.front().start_mm;
  }
  [[nodiscard]] bool done() const {
    return s_ >= path_.back().position_mm + path_.back().length_mm;
  }
  ContourError::Input step() {
    // Substeps keep the servo's own integration error small compared with what is tested.
    constexpr int kSub = 50;
    for (int i = 0; i < kSub; ++i) {
      s_ += speed_ * period_ / kSub;
      while (index_ + 1 < path_.size() && s_ > path_[index_ + 1].position_mm) {
        ++index_;
      }
      const Point before = command_;
      command_ = geometry::point_at(
          path_[index_], geometry::parameter_at(path_[index_], s_ - path_[index_].position_mm));
      if (time_s_ == 0.0 && i == 0) {
        continue;
      }
      const Point middle = geometry::scale(geometry::add(before, command_), 0.5);
      const double share = 1.0 - std::exp(-gain_ * period_ / kSub);
      actual_ = geometry::add_scaled(actual_, geometry::subtract(middle, actual_), share);
    }
    time_s_ += period_;
    return {time_s_, command_, actual_, path_, index_, s_, speed_};
  }

 private:
  PathView path_;
  double speed_;
  double gain_;
  double period_;
  double time_s_ = 0.0;
  double s_ = 0.0;
  std::size_t index_ = 0;
  Point command_{};
  Point actual_{};
};

inline ContourError estimator(double gain_1_s = 50.0) {
  ContourError::Config config;
  config.servo_gain_1_s = gain_1_s;
  return ContourError::make(config).value();
}

}  // namespace steadyrest::contour::online::test
