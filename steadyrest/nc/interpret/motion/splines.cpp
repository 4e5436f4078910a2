// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/check/block_check.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/motion/splines.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::size_t kMostPoints = 10'000;

}  // namespace

bool Splines::spline(const Step& step) {
  const int code = step.moves_by;
  if (state_.plane != Plane::xy && (code == g::kCubicSpline || code == g::kQuadraticSpline)) {
    return refusals_.g_word(step, step.moves_by, "spline_off_xy",
                            "a spline outside the XY plane (G17)");
  }
  // Control points are in XY; LinuxCNC's splines have no other plane.
  for (const char letter : std::string_view{"ZABCUVW"}) {
    if (step.has(letter)) {
      return refusals_.letter(step, letter, "axis_in_spline", "a spline moves only X and Y");
    }
  }
  if (code == g::kSplineEnd) {
    return end(step);
  }
  // G93 would need the curve's length before the curve is known.
  if (state_.feed_mode == FeedMode::inverse_time) {
    return refusals_.g_word(step, step.moves_by, "spline_in_inverse_time",
                            "a spline while inverse-time feed (G93) is in force");
  }
  if (!has_feed(step, state_, refusals_)) {
    return false;
  }
  return code == g::kCubicSpline       ? cubic(step)
         : code == g::kQuadraticSpline ? quadratic(step)
                                       : control_point(step);
}

bool Splines::words(const Step& step, std::string_view text) {
  return refusals_.g_word(step, step.moves_by, "spline_words", text);
}

bool Splines::cubic(const Step& step) {
  if (step.has('I') != step.has('J')) {
    return refusals_.letter(step, step.has('I') ? 'I' : 'J', "spline_words",
                            "G5 with only one of I and J; give both, or neither after another G5");
  }
  if (!step.has('P') || !step.has('Q')) {
    return words(step, "G5 without its second control point (P and Q, from the end)");
  }
  if (!step.has('I') && !cubic_goes_on_) {
    return words(
        step,
        "G5 without its first control point (I and J); only after another G5 may it be left out");
  }
  const Axes end = end_point(step, control_);
  const double unit = state_.unit_mm;
  // G5 after G5 without I and J: mirrors the last P and Q, so the curves join tangentially.
  const std::array<double, 2> first =
      step.has('I') ? std::array{step['I'] * unit, step['J'] * unit}
                    : std::array{-cubic_tangent_mm_[0], -cubic_tangent_mm_[1]};
  cubic_tangent_mm_ = {step['P'] * unit, step['Q'] * unit};
  const Axes& start = state_.position;
  // Cubic Bézier: start, start + (I, J), end + (P, Q), end.
  const std::array points = {
      SplinePoint{start[0], start[1], 1.0},
      SplinePoint{start[0] + first[0], start[1] + first[1], 1.0},
      SplinePoint{end[0] + cubic_tangent_mm_[0], end[1] + cubic_tangent_mm_[1], 1.0},
      SplinePoint{end[0], end[1], 1.0}};
  emit(points, 4, end);
  cubic_goes_on_ = true;
  return true;
}

bool Splines::quadratic(const Step& step) {
  if (!step.has('I') || !step.has('J')) {
    return words(step, "G5.1 without its control point (I and J, from the start)");
  }
  const Axes end = end_point(step, control_);
  const double unit = state_.unit_mm;
  const Axes& start = state_.position;
  // Quadratic Bézier: start, start + (I, J), end.
  const std::array points = {
      SplinePoint{start[0], start[1], 1.0},
      SplinePoint{start[0] + step['I'] * unit, start[1] + step['J'] * unit, 1.0},
      SplinePoint{end[0], end[1], 1.0}};
  emit(points, 3, end);
  cubic_goes_on_ = false;
  return true;
}

bool Splines::control_point(const Step& step) {
  // The first block may give only the present position its weight.
  const bool present = points_.empty() && !step.has('X') && !step.has('Y');
  if (!present && (!step.has('X') || !step.has('Y'))) {
    return words(step, "a control point without X or Y");
  }
  if (!step.has('P') || !(step['P'] > 0.0)) {
    return words(step, "a control point without its weight (P above zero)");
  }
  if (points_.size() >= kMostPoints) {
    return refusals_.letter(step, 'X', "spline_words",
                            "a spline of more than 10000 control points");
  }
  // The first G5.2 also makes the present position a control point; its P is the weight of both.
  if (points_.empty()) {
    order_ = step.has('L') ? static_cast<int>(step['L']) : 3;
    if (order_ < 2 || order_ > 8) {
      return refusals_.letter(step, 'L', "spline_words",
                              "the order of the spline (L) is out of range; allowed: 2 to 8");
    }
    points_.push_back({state_.position[0], state_.position[1], step['P']});
    end_ = state_.position;
    state_.motion = g::kSplinePoint;
    cubic_goes_on_ = false;
  } else if (step.has('L')) {
    return refusals_.letter(
        step, 'L', "spline_words",
        "an order (L) after the first block of the spline; give it in the first block");
  }
  if (state_.incremental) {
    return refusals_.letter(step, 'X', "spline_words", "control points in G91 are not interpreted");
  }
  if (!present) {
    end_ = end_point(step, control_);
    points_.push_back({end_[0], end_[1], step['P']});
  }
  return true;
}

bool Splines::end(const Step& step) {
  if (points_.empty()) {
    return words(step, "G5.3 without G5.2 before it");
  }
  // A curve of order k needs k points for one span.
  if (static_cast<int>(points_.size()) < order_) {
    return words(step, "a spline with fewer control points than its order");
  }
  emit(points_, order_, end_);
  points_.clear();
  // LinuxCNC has no motion mode after G5.3.
  state_.motion = -1;
  return true;
}

// The move only points to the control points: they must live until it has gone out and are then
// cleared.
void Splines::emit(std::span<const SplinePoint> points, int order, const Axes& end) {
  out_.current().spline = points;
  out_.current().spline_order = order;
  const PathMode mode = state_.path_mode;
  out_.move(MoveKind::spline, end);
  // A following drilling cycle takes a new initial level.
  state_.cycle.begins_anew = true;
  state_.path_mode = mode;
  out_.current().spline = {};
  out_.current().spline_order = 0;
}

}  // namespace steadyrest::nc::interpret
