// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/prove/shifts.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Axes;
using interpret::kAxisLetters;
using interpret::Move;
using interpret::MoveKind;

namespace {

// The centre as a point of all axes, so that machine_of() can rotate it.
Axes centre_of(const Move& move) {
  Axes centre = move.start;
  std::ranges::copy(move.centre_mm, centre.begin());
  return centre;
}

// A spline keeps its correction from start to end, so its points equal the original's in work
// coordinates.
bool same_points(const interpret::SplinePoint& a, const interpret::SplinePoint& b) {
  return same(a.x_mm, b.x_mm) && same(a.y_mm, b.y_mm) && a.weight == b.weight;
}

}  // namespace

Shifts::Shifts(const Plan& plan) {
  for (const AxisPlan& axis : plan.axes) {
    planned_ |= axis_bit(axis.index);
  }
}

std::string Shifts::add(const Move& move, double most_mm) {
  if (move.kind != MoveKind::rapid) {
    return "an inserted line moves, but not by a rapid";
  }
  for (std::size_t i = 0; i < shift_.size(); ++i) {
    const double distance_mm = move.end[i] - move.start[i];
    // A change moves an axis by at most twice the largest correction, from one end to the other.
    if (distance_mm != 0.0 &&
        ((planned_ & axis_bit(i)) == 0 || std::abs(distance_mm) > most_mm + kSame_mm)) {
      return "an inserted line moves more than a correction";
    }
    // An added rapid moves the changed program's axis ahead of the original's.
    shift_[i] += distance_mm;
  }
  return {};
}

/// Straight moves without rotation: starts where the previous move ended and ends where it should,
/// on every axis. False, and nothing changed, if an exception is needed. Nearly all moves take this
/// path: no rotation, no arcs, no exceptions.
bool Shifts::as_wanted(const Move& before, const Move& after) noexcept {
  Axes end{};
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double start_mm =
        (after.start[i] + after.offset[i]) - (before.start[i] + before.offset[i]);
    end[i] = (after.end[i] + after.offset[i]) - (before.end[i] + before.offset[i]);
    if (!same(start_mm, shift_[i]) || !same(end[i], wanted[i])) {
      return false;
    }
    worst_mm = std::max(worst_mm, std::abs(end[i] - wanted[i]));
  }
  shift_ = end;
  largest_error_mm_ = std::max(largest_error_mm_, worst_mm);
  return true;
}

// `shift_` is how far the changed program's machine position is from the original's. Each move must
// begin with it and end with the planned shift: the plan then takes effect on the machine, not just
// in offsets.
std::string Shifts::pair(const Move& before, const Move& after, const Frames& frames) {
  const bool turned = before.rotation_deg != 0.0 || after.rotation_deg != 0.0;
  const bool straight = before.kind == MoveKind::rapid || before.kind == MoveKind::linear;
  if (straight && !turned && as_wanted(before, after)) {
    return {};
  }
  // Work positions differ by definition (the offset is shifted); machine positions show what the
  // tool does.
  const auto difference = [&](const Axes& old_work, const Axes& new_work) {
    if (!turned) {
      Axes out;
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = (new_work[i] + after.offset[i]) - (old_work[i] + before.offset[i]);
      }
      return out;
    }
    const Axes was = machine_of(before, old_work);
    Axes is = machine_of(after, new_work);
    std::ranges::transform(is, was, is.begin(), std::minus{});
    return is;
  };
  const Difference found = {.start = difference(before.start, after.start),
                            .end = difference(before.end, after.end),
                            .centre = before.kind == MoveKind::arc
                                          ? difference(centre_of(before), centre_of(after))
                                          : Axes{}};
  for (std::size_t i = 0; i < shift_.size(); ++i) {
    if (std::string fault = one_axis(i, before, found, frames); !fault.empty()) {
      return fault;
    }
  }
  return std::ranges::equal(before.spline, after.spline, same_points)
             ? std::string{}
             : "the points of a spline differ";
}

std::string Shifts::one_axis(std::size_t axis, const Move& before, const Difference& difference,
                             const Frames& frames) {
  const double start_mm = difference.start[axis];
  const double end_mm = difference.end[axis];
  if (!same(start_mm, shift_[axis])) {
    return "a move begins where the one before it did not end";
  }
  // An axis that is not programmed, or only incrementally, keeps its shift.
  const bool may_keep = (frames.acts_at_once & axis_bit(axis)) == 0 &&
                        (frames.incremental || same(before.start[axis], before.end[axis]));
  double error_mm = std::abs(end_mm - wanted[axis]);
  if (may_keep) {
    error_mm = std::min(error_mm, std::abs(end_mm - start_mm));
  }
  // A move to machine coordinates must end where the original does.
  if (frames.machine) {
    error_mm = std::min(error_mm, std::abs(end_mm));
  }
  if (!(error_mm <= kSame_mm)) {
    return fmt::format("{} is off by {:.9f} mm after this line; the plan has {:.6f} mm",
                       kAxisLetters[axis], end_mm, wanted[axis]);
  }
  // On an arc or spline, a shift that grows along the way makes another curve.
  const bool straight = before.kind == MoveKind::rapid || before.kind == MoveKind::linear;
  if (!straight && !same(start_mm, end_mm)) {
    return fmt::format("a correction of {} begins in a curved move and would bend it",
                       kAxisLetters[axis]);
  }
  // The centre along the normal does not matter.
  if (before.kind == MoveKind::arc && axis < before.normal.size() && before.normal[axis] == 0.0) {
    const double centre_mm = difference.centre[axis];
    if (!same(centre_mm, start_mm)) {
      return fmt::format("the centre of an arc is off by {:.9f} mm in {}", centre_mm,
                         kAxisLetters[axis]);
    }
  }
  shift_[axis] = end_mm;
  largest_error_mm_ = std::max(largest_error_mm_, error_mm);
  return {};
}

}  // namespace steadyrest::nc::rewrite
