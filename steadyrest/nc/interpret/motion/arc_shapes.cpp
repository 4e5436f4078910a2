// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/motion/motion.hpp>
#include <steadyrest/nc/interpret/state/offset_corner.hpp>

// Arcs of sinumerik that give no centre ("Fundamentals", "Circular interpolation"):
//
//   AR   angle α:      R = c/(2·sin α/2) for the chord c; with a centre the end is the start turned
//   CIP  through Q:    centre where the perpendicular bisectors of start–Q and Q–end meet
//   CT   tangent t:    R = c²/(2·n·c) with n the left normal of t; R > 0 is counter-clockwise
namespace steadyrest::nc::interpret {
namespace {

// Shorter lengths and narrower angles than these leave the centre to rounding: LinuxCNC's smallest
// radius (mm), and rad.
constexpr double kSmallest_mm = 0.00127;
constexpr double kSmallest_rad = 1e-9;

double cross_of(PlanePoint a, PlanePoint b) noexcept {
  return a.first * b.second - a.second * b.first;
}
PlanePoint in_plane(const Axes& point, const PlaneAxes& axes) noexcept {
  return {.first = point[axes.first], .second = point[axes.second]};
}

}  // namespace

// The end or the centre, and the angle of the arc.
bool Motion::by_angle(const Step& step, const PlaneAxes& axes, Arc& arc) {
  constexpr std::string_view kLetters = "XYZ";
  const bool clockwise = step.moves_by == g::kArcClockwise;
  const double angle = step.named->arc_angle_deg * kernel::units::kDegree;
  const PlanePoint start = in_plane(state_.position, axes);
  const bool ends = step.has(kLetters[axes.first]) || step.has(kLetters[axes.second]);
  const bool centred = (step.mask & kCentreMask) != 0;
  if (step.has('R') || step.has('P') || ends == centred) {
    return refusals_.named(step, "AR", "arc_centre_twice",
                           "an arc by its angle (AR) needs either its end or its centre");
  }
  if (centred) {
    Axes at_start = state_.position;
    if (!arc_words(step, axes) || !arc_centre(step, axes, at_start, arc.centre)) {
      return false;
    }
    const PlanePoint arm = between(arc.centre, start);
    const double turn = clockwise ? -angle : angle;
    arc.end[axes.first] =
        arc.centre.first + arm.first * std::cos(turn) - arm.second * std::sin(turn);
    arc.end[axes.second] =
        arc.centre.second + arm.first * std::sin(turn) + arm.second * std::cos(turn);
    return true;
  }
  const PlanePoint chord = between(start, in_plane(arc.end, axes));
  const double reach = length(chord);
  if (reach < kSmallest_mm) {
    return refusals_.named(step, "AR", "arc_without_chord",
                           "an arc by its angle whose end is its start");
  }
  // The centre lies beside the chord's midpoint, on the left of a counter-clockwise arc up to 180°.
  const double beside = 0.5 / std::tan(0.5 * angle) * (clockwise ? -1.0 : 1.0);
  arc.centre = {.first = start.first + 0.5 * chord.first - beside * chord.second,
                .second = start.second + 0.5 * chord.second + beside * chord.first};
  return true;
}

// Each word of the way counts as the axis words do: from the work zero, or in G91 from the start.
bool Motion::by_way(const Step& step, const PlaneAxes& axes, Arc& arc) {
  const PlanePoint start = in_plane(state_.position, axes);
  Axes way = state_.position;
  const unsigned plane = 1U << axes.first | 1U << axes.second;
  const unsigned given = step.named ? step.named->way_given : 0U;
  if ((given & plane) != plane) {
    return refusals_.g_word(step, g::kArcThrough, "arc_way_missing",
                            "a circle through a point (CIP) without that point in the plane "
                            "(I1 J1 K1)");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const unsigned bit = 1U << i;
    if ((given & bit) == 0) {
      continue;
    }
    const bool adds = (step.named->way_incremental & bit) != 0 ||
                      (state_.incremental && (step.named->way_absolute & bit) == 0);
    const double value = step.named->way[i] * state_.unit_mm;
    if (!(std::abs(value) <= 1e8) || (i == 0 && state_.diameter)) {
      return refusals_.g_word(step, g::kArcThrough, "out_of_range",
                              "a point on the way that is too far, or in diameters");
    }
    way[i] = value + (adds ? state_.position[i] : 0.0);
  }
  const double height = state_.position[axes.normal];
  if (std::abs(way[axes.normal] - height) > 1e-6 ||
      std::abs(arc.end[axes.normal] - height) > 1e-6) {
    return refusals_.g_word(step, g::kArcThrough, "arc_off_plane",
                            "a circle through a point (CIP) that leaves the plane in force");
  }
  const PlanePoint first = between(start, in_plane(way, axes));
  const PlanePoint chord = between(start, in_plane(arc.end, axes));
  const double twice_area = cross_of(first, chord);
  const double longest = std::max(length(first), length(chord));
  if (std::abs(twice_area) <= kSmallest_rad * longest * longest ||
      length(between(first, chord)) < kSmallest_mm) {
    return refusals_.g_word(step, g::kArcThrough, "arc_way_in_line",
                            "a circle through a point (CIP) whose three points are in line");
  }
  // In coordinates from the start the centre solves 2·m·first = first², 2·m·chord = chord².
  const double a = 0.5 * dot(first, first) / twice_area;
  const double b = 0.5 * dot(chord, chord) / twice_area;
  arc.centre = {.first = start.first + a * chord.second - b * first.second,
                .second = start.second + b * first.first - a * chord.first};
  arc.turns = twice_area > 0.0 ? 1.0 : -1.0;
  return true;
}

bool Motion::by_tangent(const Step& step, const PlaneAxes& axes, Arc& arc) {
  PlanePoint tangent;
  if (!last_direction(axes, tangent)) {
    return refusals_.g_word(step, g::kArcTangent, "arc_tangent_missing",
                            "a tangential circle (CT), but the block before it does not say its "
                            "direction in this plane");
  }
  const PlanePoint start = in_plane(state_.position, axes);
  const PlanePoint chord = between(start, in_plane(arc.end, axes));
  const double reach = length(chord);
  if (reach < kSmallest_mm) {
    return refusals_.g_word(step, g::kArcTangent, "arc_without_chord",
                            "a tangential circle (CT) whose end is its start");
  }
  const double side = cross_of(tangent, chord);  // n·c
  // "Fundamentals", CT: along the tangent it is a straight line.
  if (std::abs(side) <= kSmallest_rad * reach) {
    arc.straight = dot(tangent, chord) > 0.0;
    return arc.straight || refusals_.g_word(step, g::kArcTangent, "arc_zero_radius",
                                            "a tangential circle (CT) straight back");
  }
  const double radius = 0.5 * reach * reach / side;
  arc.centre = {.first = start.first - radius * tangent.second,
                .second = start.second + radius * tangent.first};
  arc.turns = side > 0.0 ? 1.0 : -1.0;
  return true;
}

// The end of the last move in the plane; false where it does not say a direction, or where the
// work coordinates have turned since.
bool Motion::last_direction(const PlaneAxes& axes, PlanePoint& direction) const noexcept {
  const Move& last = out_.current();
  if (last.rotation_deg != state_.rotation_in_force_deg || out_.beside()) {
    return false;
  }
  if (last.kind == MoveKind::arc) {
    direction = leaving_;
    return leaving_axes_.normal == axes.normal;
  }
  direction = between(in_plane(last.start, axes), in_plane(last.end, axes));
  const double reach = length(direction);
  if (reach < kSmallest_mm) {
    return false;
  }
  direction = {.first = direction.first / reach, .second = direction.second / reach};
  return true;
}

void Motion::keep_direction(const PlaneAxes& axes, const Arc& arc) noexcept {
  const PlanePoint arm = between(arc.centre, in_plane(arc.end, axes));
  const double reach = std::max(length(arm), kSmallest_mm);
  const double sense = arc.turns < 0.0 ? -1.0 : 1.0;
  leaving_ = {.first = -sense * arm.second / reach, .second = sense * arm.first / reach};
  leaving_axes_ = axes;
}

}  // namespace steadyrest::nc::interpret
