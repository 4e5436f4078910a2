// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// G5 (cubic), G5.1 (quadratic), G5.2 … G5.3 (control points with weights): splines in the XY
/// plane. After G5 and G5.1 the previous motion mode is in force again, after G5.3 none.
class Splines : private Stage {
 public:
  using Stage::Stage;

  bool spline(const Step& step);
  /// Control points of G5.2 are waiting for G5.3: no other motion is allowed.
  [[nodiscard]] bool open() const noexcept { return !points_.empty(); }
  /// Another motion intervenes: the next G5 needs its first control point.
  void interrupt() noexcept { cubic_goes_on_ = false; }

 private:
  bool cubic(const Step& step);
  bool quadratic(const Step& step);
  bool control_point(const Step& step);
  bool end(const Step& step);
  void emit(std::span<const SplinePoint> points, int order, const Axes& end);
  bool words(const Step& step, std::string_view text);

  std::array<double, 2> cubic_tangent_mm_{};  ///< P and Q of the last G5
  bool cubic_goes_on_ = false;
  std::vector<SplinePoint> points_;  ///< of G5.2
  int order_ = 0;
  Axes end_{};
};

}  // namespace steadyrest::nc::interpret
