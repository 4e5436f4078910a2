// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/offline/predistort/polish/chain_motion.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr double kStraightPiece_1_mm = 1e-6;
constexpr double kSlow_mm_s = 0.1;
constexpr double kRamp_s = 0.02;  ///< at constant speed, before the pieces

nc::interpret::Move move_of(const ChainPiece& piece, const nc::interpret::PlaneAxes& axes,
                            std::uint32_t line) {
  nc::interpret::Move move;
  move.line = line;
  move.path_mode = nc::interpret::PathMode::exact_path;
  move.feed_mm_s = piece.feed_mm_s;
  const auto put = [&](const Heading& at, double height, nc::interpret::Axes& into) {
    into[axes.first] = at.x_mm;
    into[axes.second] = at.y_mm;
    into[axes.normal] = height;
  };
  const PlanarArc& arc = piece.arc;
  put(arc.start, piece.height_mm, move.start);
  put(along(arc, arc.length_mm), piece.height_mm + piece.slope * arc.length_mm, move.end);
  move.kind = nc::interpret::MoveKind::linear;
  if (std::abs(arc.curvature_1_mm) > kStraightPiece_1_mm) {
    move.kind = nc::interpret::MoveKind::arc;
    move.turns = arc.curvature_1_mm > 0.0 ? 1 : -1;
    move.normal[axes.normal] = 1.0;
    move.centre_mm[axes.normal] = piece.height_mm;
    move.centre_mm[axes.first] =
        arc.start.x_mm - std::sin(arc.start.angle_rad) / arc.curvature_1_mm;
    move.centre_mm[axes.second] =
        arc.start.y_mm + std::cos(arc.start.angle_rad) / arc.curvature_1_mm;
  }
  return move;
}

}  // namespace

double ChainMotion::lead_in_mm(double speed_mm_s) const {
  double least = kernel::machine::kUnlimited;
  for (const auto& axis : machine_.axes) {
    least = std::min(least, axis.max_acceleration_au_s2);
  }
  return speed_mm_s * (speed_mm_s / least + 2.0 * limits_.jerk_time_s() + kRamp_s);
}

ChainPiece ChainMotion::lead_in(const ChainPiece& piece, double speed_mm_s) const {
  ChainPiece out = piece;
  const double length = lead_in_mm(speed_mm_s);
  if (std::abs(piece.arc.curvature_1_mm) * length > 0.5 * kernel::units::kTurn) {
    out.arc.curvature_1_mm = 0.0;
  }
  out.arc.start = along(out.arc, -length);
  out.arc.length_mm = length;
  out.height_mm -= out.slope * length;
  out.feed_mm_s = speed_mm_s;
  return out;
}

double ChainMotion::curve_mm_s(const ChainPiece& piece) const noexcept {
  const double curvature = std::abs(piece.arc.curvature_1_mm);
  Point normal{};
  normal[axes_.normal] = 1.0;
  return curvature > kStraightPiece_1_mm
             ? limits_.circle(1.0 / curvature, limits_.plane(normal)).speed_mm_s
             : kernel::machine::kUnlimited;
}

bool ChainMotion::run(std::span<const ChainPiece> pieces, double rest_s, double from_mm_s) {
  nc::plan::PathBuilder builder(machine_);
  if (from_mm_s > 0.0) {
    builder.on_move(move_of(lead_in(pieces.front(), from_mm_s), axes_, 0));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    builder.on_move(move_of(pieces[i], axes_, static_cast<std::uint32_t>(i + 1)));
  }
  const auto path = builder.take();
  if (!path) {
    return false;
  }
  auto interpolator = nc::plan::Interpolator::make(machine_, nc::plan::whole(*path));
  if (!interpolator) {
    return false;
  }
  const double period_s = machine_.control.interpolator_period_s;
  command_.clear();
  begin_s_.assign(pieces.size() + 1, 0.0);
  after_s_ = 0.0;
  std::size_t piece = 0;
  std::size_t count = 0;
  for (;;) {
    const nc::plan::Setpoint s = interpolator->update({}, count % every_ == 0);
    if (s.finished) {
      break;
    }
    if (s.line == 0) {
      continue;
    }
    if (count++ % every_ == 0) {
      command_.push_back({s.position[0], s.position[1], s.position[2]});
    }
    const double past_s = (s.path_position_mm - path->segments[s.path_index].position_mm) /
                          std::max(s.path_speed_mm_s, kSlow_mm_s);
    const double begins_s =
        static_cast<double>(count - 1) * period_s - std::clamp(past_s, 0.0, period_s);
    if (count == 1 && from_mm_s > 0.0) {
      after_s_ = -begins_s;
    }
    for (; piece + 1 < s.line; ++piece) {
      begin_s_[piece + 1] = begins_s;
    }
  }
  for (; piece < pieces.size(); ++piece) {
    begin_s_[piece + 1] = static_cast<double>(count) * period_s;
  }
  if (command_.empty()) {
    return false;
  }
  const auto rest =
      static_cast<std::size_t>(std::ceil(rest_s / (period_s * static_cast<double>(every_))));
  command_.insert(command_.end(), rest, Point(command_.back()));
  return true;
}

}  // namespace steadyrest::contour::offline
