// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/motion/cutter_stage.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {

/// Moves of a single block: straight lines, arcs, probing, reference points.
class Motion : private Stage {
 public:
  Motion(Control& control, MoveOutput& out, CutterStage& cutter, Parameters& parameters) noexcept
      : Stage(control, out), cutter_(cutter), parameters_(parameters) {}

  bool straight(const Step& step);
  /// G2, G3; of sinumerik also by its angle (AR), CIP and CT.
  bool arc(const Step& step);
  /// sinumerik G63: at the programmed feed, which no override may change.
  bool tap_floating(const Step& step);
  bool probe(const Step& step);
  /// G28 (`which` 0), G30 (1).
  void home(const Step& step, std::size_t which);
  /// M6 before the change: stops the spindle and goes where the control's configuration says.
  void to_tool_change();

 private:
  /// An arc in the plane in force.
  struct Arc {
    Axes end{};
    PlanePoint centre;
    double turns = 1.0;  ///< < 0 clockwise
    bool straight = false;
  };
  bool shape(const Step& step, const PlaneAxes& axes, Arc& arc);
  // arc_shapes.cpp
  bool by_angle(const Step& step, const PlaneAxes& axes, Arc& arc);
  bool by_way(const Step& step, const PlaneAxes& axes, Arc& arc);
  bool by_tangent(const Step& step, const PlaneAxes& axes, Arc& arc);
  bool last_direction(const PlaneAxes& axes, PlanePoint& direction) const noexcept;
  void keep_direction(const PlaneAxes& axes, const Arc& arc) noexcept;

  bool arc_words(const Step& step, const PlaneAxes& axes);
  bool arc_centre(const Step& step, const PlaneAxes& axes, const Axes& end, PlanePoint& centre);
  [[nodiscard]] double reference_of(std::size_t which, std::size_t axis,
                                    double reference) const noexcept;
  bool refuse_arc(const Step& step, ArcFault fault);

  PlanePoint leaving_;  ///< direction at the end of the last arc, in its plane
  PlaneAxes leaving_axes_{};
  CutterStage& cutter_;
  Parameters& parameters_;
};

}  // namespace steadyrest::nc::interpret
