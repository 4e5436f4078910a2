// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Cells are made once as the command moves along, a bounded number per cycle; a backward pass over
// the speed limits runs with each new cell. Lines and arcs become parabolas, so the forecast needs
// only one kind of piece.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// 0.1 rad: above the breaks between cells of a smooth path, kChordTurn or the 0.003 rad by which a
// parabola over 0.2 rad misses its arc's direction; below the corners whose far side the foot must
// find.
constexpr double kCornerCosine = 0.995;
// A chord of length L over lines that turn by φ cuts off L·φ/8: 0.1 mm and 0.02 rad give 0.25 µm.
constexpr double kChordTurn = 0.02;
constexpr double kChordMm = 0.1;

/// The term that the parabola omits: h³/6·(κ² + |dκ/ds|) ≤ 2·10⁻⁵ mm, so h³ ≤ 1.2·10⁻⁴/(…).
double arc_cell_mm(const PathSegment& segment, double curvature_1_mm) noexcept {
  const double wound = std::abs(1.0 / std::max(segment.radius_end_mm, 1e-3) -
                                1.0 / std::max(segment.radius_mm, 1e-3)) /
                       segment.length_mm;
  const double third = curvature_1_mm * curvature_1_mm + wound;
  const double by_third = third > 0.0 ? std::cbrt(1.2e-4 / third) : 1.0;
  return std::clamp(std::min(by_third, 0.2 / std::max(curvature_1_mm, 1e-9)), 0.002, 1.0);
}

/// Tells whether the next cell's direction differs from the one `before` ends with: at its end the
/// tangent has turned by κ⃗·length.
bool breaks(const Cell& before, const Cell& next) noexcept {
  const Point out = geometry::add_scaled(before.tangent, before.curvature_1_mm, before.length_mm);
  return geometry::dot(out, next.tangent) <
         kCornerCosine * geometry::norm(out) * geometry::norm(next.tangent);
}

}  // namespace

LookAhead::LookAhead(std::span<const kernel::machine::Axis> axes,
                     double max_path_acceleration_mm_s2, double tool_turn_mm_s)
    : path_mm_s2_(max_path_acceleration_mm_s2),
      tool_turn_mm_s_(tool_turn_mm_s),
      ring_(std::make_unique<std::array<Cell, kCells>>()) {
  for (std::size_t i = 0; i < 3; ++i) {
    axis_mm_s2_[i] = i < axes.size() ? axes[i].max_acceleration_au_s2 : kInfinite;
  }
}
LookAhead::~LookAhead() = default;
LookAhead::LookAhead(LookAhead&&) noexcept = default;
LookAhead& LookAhead::operator=(LookAhead&&) noexcept = default;

Cell& LookAhead::at(std::size_t i) noexcept {
  return (*ring_)[i % kCells];
}

void LookAhead::reset() noexcept {
  first_ = last_ = 0;
  path_data_ = nullptr;
  complete_ = false;
}

LookAhead::State LookAhead::state() const {
  State state{.cell = {},
              .first = first_,
              .last = last_,
              .path = path_data_,
              .next_segment = next_segment_,
              .next_offset_mm = next_offset_mm_,
              .joint_mm_s = joint_mm_s_,
              .made_to_mm = made_to_mm_,
              .complete = complete_};
  for (std::size_t i = first_; i < last_; ++i) {
    state.cell.push_back(cell(i));
  }
  return state;
}

// A state whose cells do not match its indices is dropped; the next update rebuilds the cells.
void LookAhead::restore(const State& state) noexcept {
  reset();
  if (state.last - state.first != state.cell.size() || state.cell.size() > kCells) {
    return;
  }
  first_ = state.first;
  last_ = state.last;
  for (std::size_t i = first_; i < last_; ++i) {
    at(i) = state.cell[i - first_];
  }
  path_data_ = state.path;
  next_segment_ = state.next_segment;
  next_offset_mm_ = state.next_offset_mm;
  joint_mm_s_ = state.joint_mm_s;
  made_to_mm_ = state.made_to_mm;
  complete_ = state.complete;
}

double LookAhead::known_to_mm() const noexcept {
  return made_to_mm_;
}

// The axis that reaches its limit first in this direction sets the path's limit.
double LookAhead::line_acceleration(const Point& direction) const noexcept {
  double a = path_mm_s2_;
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = std::abs(direction[i]);
    if (share > 1e-9) {
      a = std::min(a, axis_mm_s2_[i] / share);
    }
  }
  return std::min(a, 1e9);
}

// An arc passes through every direction of its plane, so the largest share of each axis counts: √(1
// − n²), n the plane's normal.
double LookAhead::arc_acceleration(const PathSegment& segment) const noexcept {
  double plane = path_mm_s2_;
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = segment.axis[i];
    const double share = std::sqrt(std::max(0.0, 1.0 - n * n));
    if (share > 1e-9) {
      plane = std::min(plane, axis_mm_s2_[i] / share);
    }
  }
  plane = std::min(plane, 1e9);
  // What the turn at the highest speed leaves; never less than half, which is how controls share
  // it.
  const double v = std::min(segment.speed_limit_mm_s, 2.0 * segment.feed_mm_s);
  const double r = std::max(1e-6, std::min(segment.radius_mm, segment.radius_end_mm));
  const double turn = std::min(v * v / r, 0.866 * plane);
  return std::sqrt(plane * plane - turn * turn);
}

void LookAhead::describe(Cell& cell, const PathSegment& segment) const noexcept {
  cell.feed_mm_s = segment.feed_mm_s;
  cell.cap_mm_s = segment.speed_limit_mm_s;
  cell.cutting = segment.motion == Motion::feed;
  cell.rapid = segment.motion == Motion::rapid;
  cell.by_text = segment.by_text;
}

/// How fast the tool point may go round the joint before the next cell.
double LookAhead::tool_limit_mm_s(const Cell& next) const noexcept {
  if (empty() || !std::isfinite(tool_turn_mm_s_)) {
    return kInfinite;
  }
  const Cell& before = cell(last_ - 1);
  if (!before.cutting && !next.cutting) {
    return kInfinite;  // in the air it may cut corners
  }
  const Point out = geometry::add_scaled(before.tangent, before.curvature_1_mm, before.length_mm);
  const double turn = geometry::distance(geometry::unit(out), geometry::unit(next.tangent));
  return turn > 0.0 ? tool_turn_mm_s_ / turn : kInfinite;
}

// square_i = min(limit², square_{i+1} + 2·a·length), v² = v₀² + 2as read backwards. The pass ends
// at the first cell that is not lowered, since those before it already agree: each cell is lowered
// a few times at most.
void LookAhead::lower_before(double Cell::* square) noexcept {
  for (std::size_t i = last_ - 1; i > first_; --i) {
    Cell& before = at(i - 1);
    const double bound = at(i).*square + 2.0 * before.acceleration_mm_s2 * before.length_mm;
    if (bound >= before.*square) {
      break;
    }
    before.*square = bound;
  }
}

void LookAhead::append(Cell cell, double joint_limit_mm_s) noexcept {
  const auto squared = [](double limit) { return limit < 1e150 ? limit * limit : kInfinite; };
  cell.square_mm2_s2 = squared(std::min(cell.cap_mm_s, joint_limit_mm_s));
  cell.tool_square_mm2_s2 = squared(tool_limit_mm_s(cell));
  made_to_mm_ = cell.position_mm + cell.length_mm;
  at(last_) = cell;
  ++last_;
  lower_before(&Cell::square_mm2_s2);
  lower_before(&Cell::tool_square_mm2_s2);
}

/// At the path's end: a piece of zero length whose speed is the limit there.
void LookAhead::append_stop() noexcept {
  complete_ = true;
  if (empty()) {
    return;
  }
  Cell stop = cell(last_ - 1);
  const double length = stop.length_mm;
  stop.point_mm = geometry::add_scaled(geometry::add_scaled(stop.point_mm, stop.tangent, length),
                                       stop.curvature_1_mm, 0.5 * length * length);
  stop.tangent = geometry::add_scaled(stop.tangent, stop.curvature_1_mm, length);
  stop.curvature_1_mm = {};
  stop.position_mm += length;
  stop.length_mm = 0.0;
  stop.corner = false;
  append(stop, 0.0);
}

/// The next piece of an arc, short enough for the cell's parabola to follow it.
void LookAhead::take_from_arc(const PathSegment& segment, Cell& cell) noexcept {
  const double left = segment.length_mm - next_offset_mm_;
  const geometry::Station here =
      geometry::station_at(segment, geometry::parameter_at(segment, next_offset_mm_));
  const double wish = arc_cell_mm(segment, geometry::norm(here.curvature_1_mm));
  // The last two cells share the rest, so that no sliver remains.
  cell.length_mm = left <= wish ? left : std::min(wish, 0.5 * left);
  cell.point_mm = here.point_mm;
  cell.tangent = here.tangent;
  cell.curvature_1_mm = here.curvature_1_mm;
  cell.acceleration_mm_s2 = arc_acceleration(segment);
  next_offset_mm_ += cell.length_mm;
  joint_mm_s_ = kInfinite;
  if (cell.length_mm >= left) {
    joint_mm_s_ = segment.exit_speed_limit_mm_s;
    next_offset_mm_ = 0.0;
    ++next_segment_;
  }
}

/// A line, with the short ones behind it that share one chord. CAM paths have lines of a few
/// micrometres; one chord for each would fill the ring within a few millimetres. Joined only where
/// motion and feed are the same and the direction is within 0.02 rad; the strictest limit applies
/// to all.
void LookAhead::take_lines(PathView path, Cell& cell, int& segments) noexcept {
  const PathSegment& segment = path[next_segment_];
  cell.point_mm = segment.start_mm;
  const Point direction = geometry::unit(geometry::subtract(segment.end_mm, segment.start_mm));
  Point end = segment.end_mm;
  double length = segment.length_mm;
  joint_mm_s_ = segment.exit_speed_limit_mm_s;
  ++next_segment_;
  while (length < kChordMm && next_segment_ < path.size() && segments > 0) {
    const PathSegment& next = path[next_segment_];
    const Point turned = geometry::unit(geometry::subtract(next.end_mm, next.start_mm));
    if (next.geometry != Geometry::line || next.motion != segment.motion ||
        next.feed_mm_s != segment.feed_mm_s || next.by_text != segment.by_text ||
        length + next.length_mm > kChordMm ||
        geometry::dot(direction, turned) < 1.0 - 0.5 * kChordTurn * kChordTurn) {
      break;
    }
    cell.cap_mm_s = std::min({cell.cap_mm_s, next.speed_limit_mm_s, joint_mm_s_});
    length += next.length_mm;
    end = next.end_mm;
    joint_mm_s_ = next.exit_speed_limit_mm_s;
    ++next_segment_;
    --segments;
  }
  const Point chord = geometry::subtract(end, cell.point_mm);
  cell.length_mm = length;
  // A chord over short lines is a little shorter than they are, and so is its "tangent".
  cell.tangent = length > 0.0 ? geometry::scale(chord, 1.0 / length) : Point{};
  cell.acceleration_mm_s2 = line_acceleration(cell.tangent);
}

bool LookAhead::add_next(PathView path, int& segments) noexcept {
  if (next_segment_ >= path.size()) {
    if (!complete_) {
      append_stop();
    }
    return false;
  }
  const PathSegment& segment = path[next_segment_];
  const double joint = joint_mm_s_;
  Cell cell;
  describe(cell, segment);
  cell.position_mm = segment.position_mm + next_offset_mm_;
  --segments;
  if (segment.geometry == Geometry::arc && segment.length_mm > 0.0) {
    take_from_arc(segment, cell);
  } else {
    take_lines(path, cell, segments);
  }
  if (!empty()) {
    cell.corner = breaks(this->cell(last_ - 1), cell);
  }
  append(cell, joint);
  return true;
}

void LookAhead::update(PathView path, std::size_t index, double from_mm, double command_mm,
                       double to_mm) noexcept {
  // Another address is another path: the present cells belong to the old one.
  const bool is_known = path_data_ == path.data() && first_ != last_ &&
                        cell(first_).position_mm <= command_mm && made_to_mm_ >= command_mm;
  if (!is_known) {
    reset();
    path_data_ = path.data();
    next_segment_ = std::min(index, path.size() - 1);
    // Back to where the foot may be, within one cycle's work.
    while (next_segment_ > 0 && path[next_segment_].position_mm > from_mm &&
           index - next_segment_ < static_cast<std::size_t>(kSegmentsPerCycle)) {
      --next_segment_;
    }
    // Within a long arc, or the cells of one cycle would never get from its start to the command.
    const PathSegment& first = path[next_segment_];
    next_offset_mm_ = first.geometry == Geometry::arc
                          ? std::clamp(from_mm - first.position_mm, 0.0, first.length_mm)
                          : 0.0;
    joint_mm_s_ = kInfinite;
    made_to_mm_ = first.position_mm + next_offset_mm_;
  }
  while (first_ + 1 < last_ && cell(first_).position_mm + cell(first_).length_mm < from_mm) {
    ++first_;
  }
  int segments = kSegmentsPerCycle;
  for (int n = 0; n < kCellsPerCycle && segments > 0 && made_to_mm_ < to_mm; ++n) {
    if (last_ - first_ >= kCells || !add_next(path, segments)) {
      break;
    }
  }
}

// Command and foot move by a cell or two per cycle: a step or two from the hint.
std::size_t LookAhead::find(double s_mm, std::size_t hint) const noexcept {
  std::size_t i = std::clamp(hint, first_, last_ - 1);
  while (i > first_ && cell(i).position_mm > s_mm) {
    --i;
  }
  while (i + 1 < last_ && cell(i).position_mm + cell(i).length_mm <= s_mm) {
    ++i;
  }
  return i;
}

}  // namespace steadyrest::contour::online
