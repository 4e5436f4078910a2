// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <steadyrest/nc/interpret/check/assumptions.hpp>
#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {

/// Canned cycles G73, G74, G81–G89. The sequence of moves is LinuxCNC 2.9's (documentation "Canned
/// cycles", and rs274 by experiment).
class Drilling : private Stage {
 public:
  Drilling(Control& control, MoveOutput& out, Assumptions& assumptions) noexcept
      : Stage(control, out), assumptions_(assumptions) {}

  /// Places of holes in the plane, work coordinates; without them the block's words say the place.
  struct Pattern {
    double count = 1.0;
    std::function<PlanePoint(double hole)> place;
  };

  bool cycle(const Step& step);
  bool cycle(const Step& step, const Pattern& pattern);

 private:
  /// One hole, in mm along the normal axis of the plane.
  struct Hole {
    PlaneAxes axes;
    double initial_mm;  ///< where the cycle began
    double retract_mm;  ///< R plane
    double bottom_mm;
    double clear_mm;  ///< where the cycle ends: R plane (G99) or initial level (G98)
  };

  /// Of G87 that shifts by Q, along the normal axis.
  struct Levels {
    double below_mm;
    double upper_mm;
    double initial_mm;
  };

  bool check(const Step& step);
  bool check_peck_words(const Step& step);
  [[nodiscard]] bool by_words() const noexcept;
  [[nodiscard]] double next_peck_mm(double last_mm) const noexcept;
  [[nodiscard]] bool stores_alone(const Step& step) const noexcept;
  bool remember(const Step& step);
  bool measure(const Step& step, Hole& hole);
  void go_to(const Step& step, const Hole& hole, double height_mm);
  void go_down(const Axes& over, const Hole& hole, double height_mm);
  bool drill(const Step& step, const Hole& hole);
  bool peck(const Step& step, const Hole& hole);
  bool tap(const Step& step, const Hole& hole);
  bool bore(const Step& step, const Hole& hole);
  bool back_bore(const Step& step, const Hole& hole);
  bool fine_bore(const Step& step, const Hole& hole);
  bool back_bore_by_shift(const Step& step, const Pattern& pattern);
  void bore_upwards(const Step& step, const PlaneAxes& axes, const Levels& levels);
  [[nodiscard]] Axes beside_wall(const Step& step, const PlaneAxes& axes);

  Assumptions& assumptions_;
  double count_ = 1.0;  ///< holes of the block at hand
};

}  // namespace steadyrest::nc::interpret
