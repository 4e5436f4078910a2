// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <steadyrest/contour/offline/predistort/polish/planar_arc.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>

namespace steadyrest::contour::offline {

/// One piece of a command in a plane; along the plane's normal it runs in proportion to its length.
struct ChainPiece {
  PlanarArc arc;
  double height_mm = 0.0;  ///< at its start
  double slope = 0.0;      ///< of the height, per mm in the plane
  double feed_mm_s = 0.0;
  double programmed_mm_s = 0.0;  ///< the original's feed
  double original_slope = 0.0;   ///< where it belongs to
  bool smooth = true;            ///< it goes on from the piece before without a bend
};

/// How the control runs a few pieces of a command: nc/plan, to a standstill at their end.
class ChainMotion {
 public:
  /// A command is given out each `every` periods of the interpolator.
  ChainMotion(const kernel::machine::Machine& machine, nc::interpret::Plane plane,
              std::size_t every)
      : machine_(machine),
        every_(every),
        axes_(nc::interpret::axes_of(plane)),
        limits_(machine.axes, machine.control) {}

  /// The speed at which a piece takes all of the acceleration that the control gives to curves.
  [[nodiscard]] double curve_mm_s(const ChainPiece& piece) const noexcept;
  /// From a standstill or, on the first piece led backwards, from a speed. Behind the end the
  /// command rests for `rest_s`. Returns false if the planner refuses the pieces.
  bool run(std::span<const ChainPiece> pieces, double rest_s, double from_mm_s = 0.0);
  /// From the first one on the pieces.
  [[nodiscard]] const std::vector<kernel::signal::Point>& command() const noexcept {
    return command_;
  }
  /// How long the first command comes after the start of the pieces.
  [[nodiscard]] double after_s() const noexcept { return after_s_; }
  /// When each piece begins, and the end; counted from the first command.
  [[nodiscard]] const std::vector<double>& begin_s() const noexcept { return begin_s_; }

 private:
  [[nodiscard]] double lead_in_mm(double speed_mm_s) const;
  [[nodiscard]] ChainPiece lead_in(const ChainPiece& piece, double speed_mm_s) const;

  const kernel::machine::Machine& machine_;
  std::size_t every_;
  nc::interpret::PlaneAxes axes_;
  nc::plan::PathLimits limits_;
  std::vector<kernel::signal::Point> command_;
  std::vector<double> begin_s_;
  double after_s_ = 0.0;
};

}  // namespace steadyrest::contour::offline
