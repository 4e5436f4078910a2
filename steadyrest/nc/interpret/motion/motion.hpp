// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/motion/corners.hpp>
#include <steadyrest/nc/interpret/motion/cutter_stage.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {

/// Moves of a single block: straight lines, arcs, probing, reference points.
class Motion : private Stage {
 public:
  Motion(Control& control, MoveOutput& out, CutterStage& cutter, Corners& corners,
         Parameters& parameters) noexcept
      : Stage(control, out), cutter_(cutter), corners_(corners), parameters_(parameters) {}

  bool straight(const Step& step);
  bool arc(const Step& step);
  bool probe(const Step& step);
  /// G28 (`which` 0), G30 (1).
  void home(const Step& step, std::size_t which);
  /// M6 before the change: stops the spindle and goes where the control's configuration says.
  void to_tool_change();

 private:
  bool arc_words(const Step& step, const PlaneAxes& axes);
  bool arc_centre(const Step& step, const PlaneAxes& axes, const Axes& end, PlanePoint& centre);
  [[nodiscard]] double reference_of(std::size_t which, std::size_t axis,
                                    double reference) const noexcept;
  bool refuse_arc(const Step& step, ArcFault fault);
  [[nodiscard]] bool clockwise(const Step& step, const PlaneAxes& axes) const noexcept;
  bool worded_arc(const Step& step, const PlaneAxes& axes);

  CutterStage& cutter_;
  Corners& corners_;
  Parameters& parameters_;
};

}  // namespace steadyrest::nc::interpret
