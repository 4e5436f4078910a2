// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>

// G5 (cubic), G5.1 (quadratic), G5.2 … G5.3 (control points with weights): splines in the XY plane.
// Behind G5 and G5.1 the motion that was in force before goes on, behind G5.3 none is in force.
namespace steadyrest::nc::interpret {
namespace {

constexpr std::size_t kMostPoints = 10'000;

}  // namespace

bool Interpreter::spline(const Step& step) {
  const int code = motion_now_;
  if (state_.plane != Plane::xy && (code == g::kCubicSpline || code == g::kQuadraticSpline)) {
    return refuse_code(step, 'G', 5, "spline_off_xy", "a spline outside of the XY plane (G17)");
  }
  for (const char letter : std::string_view{"ZABCUVW"}) {
    if (step.has(letter)) {
      return refuse(step, letter, "axis_in_spline", "a spline moves X and Y alone");
    }
  }
  if (code == g::kSplineEnd) {
    return end_spline(step);
  }
  if (state_.feed_mode == FeedMode::inverse_time) {
    return refuse_code(step, 'G', 5, "spline_in_inverse_time",
                       "a spline while inverse-time feed (G93) is in force");
  }
  if (!has_feed(step)) {
    return false;
  }
  return code == g::kCubicSpline       ? cubic(step)
         : code == g::kQuadraticSpline ? quadratic(step)
                                       : control_point(step);
}

bool Interpreter::cubic(const Step& step) {
  if (step.has('I') != step.has('J')) {
    return refuse(step, step.has('I') ? 'I' : 'J', "spline_words",
                  "G5 takes both I and J, or neither behind another G5");
  }
  if (!step.has('P') || !step.has('Q')) {
    return refuse_code(step, 'G', 5, "spline_words",
                       "G5 without its second control point (P and Q, from the end)");
  }
  if (!step.has('I') && !cubic_goes_on_) {
    return refuse_code(step, 'G', 5, "spline_words",
                       "G5 without its first control point (I and J), not behind another G5");
  }
  Axes end;
  if (!end_point(step, end)) {
    return false;
  }
  const double unit = state_.unit_mm;
  const std::array<double, 2> first =
      step.has('I') ? std::array{step['I'] * unit, step['J'] * unit}
                    : std::array{-cubic_tangent_mm_[0], -cubic_tangent_mm_[1]};
  cubic_tangent_mm_ = {step['P'] * unit, step['Q'] * unit};
  const Axes& start = state_.position;
  const std::array points = {
      SplinePoint{start[0], start[1], 1.0},
      SplinePoint{start[0] + first[0], start[1] + first[1], 1.0},
      SplinePoint{end[0] + cubic_tangent_mm_[0], end[1] + cubic_tangent_mm_[1], 1.0},
      SplinePoint{end[0], end[1], 1.0}};
  emit_spline(points, 4, end);
  cubic_goes_on_ = true;
  return true;
}

bool Interpreter::quadratic(const Step& step) {
  if (!step.has('I') || !step.has('J')) {
    return refuse_code(step, 'G', 5, "spline_words",
                       "G5.1 without its control point (I and J, from the start)");
  }
  Axes end;
  if (!end_point(step, end)) {
    return false;
  }
  const double unit = state_.unit_mm;
  const Axes& start = state_.position;
  const std::array points = {
      SplinePoint{start[0], start[1], 1.0},
      SplinePoint{start[0] + step['I'] * unit, start[1] + step['J'] * unit, 1.0},
      SplinePoint{end[0], end[1], 1.0}};
  emit_spline(points, 3, end);
  cubic_goes_on_ = false;
  return true;
}

bool Interpreter::control_point(const Step& step) {
  if (!step.has('X') || !step.has('Y')) {
    return refuse_code(step, 'G', 5, "spline_words", "a control point without X or Y");
  }
  if (!step.has('P') || !(step['P'] > 0.0)) {
    return refuse_code(step, 'G', 5, "spline_words",
                       "a control point without its weight (P above zero)");
  }
  if (spline_points_.size() >= kMostPoints) {
    return refuse(step, 'X', "spline_words", "a spline of more than 10000 control points");
  }
  if (spline_points_.empty()) {
    spline_order_ = step.has('L') ? static_cast<int>(step['L']) : 3;
    if (spline_order_ < 2 || spline_order_ > 8) {
      return refuse(step, 'L', "spline_words", "the order of a spline (L) is 2 to 8");
    }
    spline_points_.push_back({state_.position[0], state_.position[1], step['P']});
    spline_end_ = state_.position;
    state_.motion = g::kSplinePoint;
    cubic_goes_on_ = false;
  } else if (step.has('L')) {
    return refuse(step, 'L', "spline_words", "the order (L) stands in the first block of a spline");
  }
  if (state_.incremental) {
    return refuse(step, 'X', "spline_words", "control points in G91 are not interpreted");
  }
  if (!end_point(step, spline_end_)) {
    return false;
  }
  spline_points_.push_back({spline_end_[0], spline_end_[1], step['P']});
  return true;
}

bool Interpreter::end_spline(const Step& step) {
  if (spline_points_.empty()) {
    return refuse_code(step, 'G', 5, "spline_words", "G5.3 without G5.2 before it");
  }
  if (static_cast<int>(spline_points_.size()) < spline_order_) {
    return refuse_code(step, 'G', 5, "spline_words",
                       "a spline of fewer control points than its order");
  }
  emit_spline(spline_points_, spline_order_, spline_end_);
  spline_points_.clear();
  state_.motion = -1;
  return true;
}

void Interpreter::emit_spline(std::span<const SplinePoint> points, int order, const Axes& end) {
  move_.spline = points;
  move_.spline_order = order;
  const PathMode mode = state_.path_mode;
  emit(MoveKind::spline, end);
  state_.cycle.begins_anew = true;
  state_.path_mode = mode;
  move_.spline = {};
  move_.spline_order = 0;
}

}  // namespace steadyrest::nc::interpret
