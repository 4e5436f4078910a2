// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <steadyrest/contour/offline/predistort/polish/chain_link.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

namespace {

constexpr double kLeastLink_mm = 1e-6;
constexpr double kSameRadius_mm = 1e-6;
constexpr double kSameSlope = 1e-6;
constexpr double kPieceTurn_rad = 1.0;  ///< of one piece
constexpr double kSteep = 10.0;         ///< rise per way in the plane
constexpr double kStraightArc_1_mm = 1.0 / 3000.0;

}  // namespace

std::optional<ChainPiece> flat(const Piece& from) {
  const PathSegment& of = from.segment;
  const auto axes = nc::interpret::axes_of(from.plane);
  const Point& a = of.start_mm;
  const Point tangent = geometry::station_at(of, 0.0).tangent;
  ChainPiece out;
  out.arc.start = {.x_mm = a[axes.first],
                   .y_mm = a[axes.second],
                   .angle_rad = std::atan2(tangent[axes.second], tangent[axes.first])};
  out.height_mm = a[axes.normal];
  out.feed_mm_s = of.feed_mm_s;
  const double rise = of.end_mm[axes.normal] - a[axes.normal];
  if (of.geometry == Geometry::line) {
    out.arc.length_mm =
        std::hypot(of.end_mm[axes.first] - a[axes.first], of.end_mm[axes.second] - a[axes.second]);
  } else {
    if (std::abs(of.radius_end_mm - of.radius_mm) > kSameRadius_mm ||
        std::abs(std::abs(of.axis[axes.normal]) - 1.0) > 1e-9 || !(of.radius_mm > 0.0)) {
      return std::nullopt;
    }
    out.arc.curvature_1_mm = (of.axis[axes.normal] > 0.0 ? 1.0 : -1.0) / of.radius_mm;
    out.arc.length_mm = of.radius_mm * of.sweep_rad;
  }
  if (out.arc.length_mm < kLeastLink_mm) {
    return std::nullopt;
  }
  out.slope = rise / out.arc.length_mm;
  if (std::abs(out.slope) > kSteep) {
    return std::nullopt;
  }
  return out;
}

Piece in_space(const Link& link) {
  Piece out = link.of;
  const auto axes = nc::interpret::axes_of(out.plane);
  const ChainPiece& piece = link.piece;
  const auto point = [&](double distance) {
    const Heading at = along(piece.arc, distance);
    Point p{};
    p[axes.first] = at.x_mm;
    p[axes.second] = at.y_mm;
    p[axes.normal] = piece.height_mm + piece.slope * distance;
    return p;
  };
  PathSegment segment = line_segment(point(0.0), point(piece.arc.length_mm));
  const double curvature = piece.arc.curvature_1_mm;
  if (std::abs(curvature) > kStraightArc_1_mm) {
    segment.geometry = Geometry::arc;
    const double angle = piece.arc.start.angle_rad;
    segment.centre_mm = segment.start_mm;
    segment.centre_mm[axes.first] -= std::sin(angle) / curvature;
    segment.centre_mm[axes.second] += std::cos(angle) / curvature;
    const double side = curvature > 0.0 ? 1.0 : -1.0;
    segment.axis[axes.normal] = side;
    segment.radius_mm = segment.radius_end_mm = 1.0 / std::abs(curvature);
    segment.sweep_rad = piece.arc.length_mm * std::abs(curvature);
    segment.rise_mm = side * piece.slope * piece.arc.length_mm;
    segment.length_mm = piece.arc.length_mm * std::hypot(1.0, piece.slope);
  }
  segment.line = out.segment.line;
  segment.motion = out.segment.motion;
  segment.feed_mm_s = piece.feed_mm_s;
  out.segment = segment;
  return out;
}

void level(std::span<ChainPiece> pieces, double tolerance_mm, bool alike) {
  const auto end_mm = [&](std::size_t i) {
    return pieces[i].height_mm + pieces[i].slope * pieces[i].arc.length_mm;
  };
  // The pieces [first, last) have one slope; false where a joint is too far from it.
  const auto is_straight = [&](std::size_t first, std::size_t last, double slope) {
    double height = pieces[first].height_mm;
    for (std::size_t i = first; i + 1 < last; ++i) {
      height += slope * pieces[i].arc.length_mm;
      if (std::abs(end_mm(i) - height) > tolerance_mm) {
        return false;
      }
    }
    return true;
  };
  for (std::size_t first = 0; first < pieces.size();) {
    double slope = pieces[first].slope;
    std::size_t last = first + 1;
    for (double whole = pieces[first].arc.length_mm; last < pieces.size(); ++last) {
      whole += pieces[last].arc.length_mm;
      const double over = (end_mm(last) - pieces[first].height_mm) / whole;
      const bool same = alike && std::abs(pieces[last].original_slope -
                                          pieces[first].original_slope) < kSameSlope;
      if (!same && !is_straight(first, last + 1, over)) {
        break;
      }
      slope = over;
    }
    double height = pieces[first].height_mm;
    for (; first < last; ++first) {
      pieces[first].height_mm = height;
      pieces[first].slope = slope;
      height += slope * pieces[first].arc.length_mm;
    }
  }
}

void halve(Link& one, Link& two) {
  two = one;
  const double half = 0.5 * one.piece.arc.length_mm;
  const double middle = 0.5 * (one.of.progress_start_mm + one.of.progress_end_mm);
  two.piece.arc.start = along(one.piece.arc, half);
  two.piece.arc.length_mm = one.piece.arc.length_mm = half;
  two.piece.height_mm += two.piece.slope * half;
  two.piece.smooth = true;
  two.of.progress_start_mm = one.of.progress_end_mm = middle;
  two.of.begins_run = false;
  two.of.joined = true;
}

void divide(std::vector<Link>& chain) {
  for (std::size_t i = 0; i < chain.size();) {
    const PlanarArc& arc = chain[i].piece.arc;
    if (std::abs(arc.curvature_1_mm) * arc.length_mm <= kPieceTurn_rad) {
      ++i;
      continue;
    }
    chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(i), Link(chain[i]));
    halve(chain[i], chain[i + 1]);
  }
}

void share_progress(std::span<Link> chain, std::pair<std::size_t, std::size_t> range,
                    double leaves_mm, double arrives_mm) {
  const auto [first, last] = range;
  const auto moved = [](const Link& link, double was_mm) {
    const double span = link.of.progress_end_mm - link.of.progress_start_mm;
    return was_mm > 0.0 ? span / was_mm * (link.piece.arc.length_mm - was_mm) : 0.0;
  };
  double at = chain[first].of.progress_start_mm;
  double end = chain[last - 1].of.progress_end_mm;
  if (leaves_mm > 0.0) {
    Link& leaves = chain[first - 1];
    at = leaves.of.progress_end_mm += moved(leaves, leaves_mm);
  }
  if (arrives_mm > 0.0) {
    Link& arrives = chain[last];
    end = arrives.of.progress_start_mm - moved(arrives, arrives_mm);
    end = arrives.of.progress_start_mm = std::max(at, end);
  }
  double whole = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    whole += chain[i].piece.arc.length_mm;
  }
  const double span = std::max(0.0, end - at);
  for (std::size_t i = first; i < last; ++i) {
    chain[i].of.progress_start_mm = at;
    at += span * chain[i].piece.arc.length_mm / whole;
    chain[i].of.progress_end_mm = at;
  }
}

}  // namespace steadyrest::contour::offline
