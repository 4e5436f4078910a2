// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/state/spline_curve.hpp>
#include <steadyrest/nc/plan/path/spline_lines.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::Move;
using interpret::SplinePoint;

/// Distance of p from the line through a and b.
double distance_mm(const SplinePoint& p, const SplinePoint& a, const SplinePoint& b) {
  const double dx = b.x_mm - a.x_mm;
  const double dy = b.y_mm - a.y_mm;
  const double length = std::hypot(dx, dy);
  const double px = p.x_mm - a.x_mm;
  const double py = p.y_mm - a.y_mm;
  return length > 0.0 ? std::abs(dx * py - dy * px) / length : std::hypot(px, py);
}

// Halves each knot span and emits each chord once the next is known, so that the last one can end
// exactly on the programmed point. Splines lie in the XY plane; the other axes keep their start
// values until that last point.
class Halving {
 public:
  Halving(const Move& move, double tolerance_mm, const std::function<void(const Move&)>& line)
      : move_(move), tolerance_mm_(tolerance_mm), line_(line), chord_(move), last_(move.start) {
    chord_.kind = interpret::MoveKind::linear;
    chord_.spline = {};
    chord_.spline_order = 0;
    chord_.in_spline = true;
  }

  void span(double u0, double u1) { halve(u0, at(u0), u1, at(u1), 0); }
  /// The last chord ends on the programmed point.
  void finish() {
    next_ = move_.end;
    give();
  }

 private:
  [[nodiscard]] SplinePoint at(double u) const {
    return interpret::spline_at(move_.spline, move_.spline_order, u);
  }
  // The test looks only at the middle of the span. An inflexion there puts the middle on the chord
  // however far the curve swings on either side, hence the least number of halvings.
  // NOLINTNEXTLINE(misc-no-recursion): bounded by kMostHalvings
  void halve(double u0, const SplinePoint& p0, double u1, const SplinePoint& p1, int depth) {
    const double middle = 0.5 * (u0 + u1);
    const SplinePoint p = at(middle);
    if (depth >= kLeastHalvings &&
        (depth >= kMostHalvings || distance_mm(p, p0, p1) <= tolerance_mm_)) {
      if (waits_) {
        give();
      }
      next_ = move_.start;
      next_[0] = p1.x_mm;
      next_[1] = p1.y_mm;
      waits_ = true;
      return;
    }
    halve(u0, p0, middle, p, depth + 1);
    halve(middle, p, u1, p1, depth + 1);
  }
  void give() {
    chord_.start = last_;
    chord_.end = next_;
    last_ = next_;
    if (chord_.start != chord_.end) {
      line_(chord_);
    }
  }

  const Move& move_;
  double tolerance_mm_;
  const std::function<void(const Move&)>& line_;
  Move chord_;
  interpret::Axes last_;
  interpret::Axes next_{};
  bool waits_ = false;
};

}  // namespace

void spline_lines(const Move& move, double tolerance_mm,
                  const std::function<void(const Move&)>& line) {
  Halving halving(move, tolerance_mm, line);
  const int spans = interpret::spline_spans(move.spline, move.spline_order);
  // Knots of these splines are one apart: span i runs from u = i to i + 1.
  for (int i = 0; i < spans; ++i) {
    halving.span(i, i + 1);
  }
  halving.finish();
}

}  // namespace steadyrest::nc::plan
