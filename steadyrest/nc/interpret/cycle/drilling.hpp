// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Canned cycles G73, G74, G81–G89. The sequence of moves is LinuxCNC 2.9's (documentation "Canned
/// cycles", and rs274 by experiment).
class Drilling : private Stage {
 public:
  using Stage::Stage;

  bool cycle(const Step& step);

 private:
  /// One hole, in mm along the normal axis of the plane.
  struct Hole {
    PlaneAxes axes;
    double initial_mm;  ///< where the cycle began
    double retract_mm;  ///< R plane
    double bottom_mm;
    double clear_mm;  ///< where the cycle ends: R plane (G99) or initial level (G98)
  };

  bool check(const Step& step);
  [[nodiscard]] bool stores_alone(const Step& step) const noexcept;
  bool remember(const Step& step);
  bool measure(const Step& step, Hole& hole);
  void go_to(const Step& step, const Hole& hole, double height_mm);
  bool drill(const Step& step, const Hole& hole);
  bool peck(const Step& step, const Hole& hole);
  bool tap(const Step& step, const Hole& hole);
  bool bore(const Step& step, const Hole& hole);
  bool back_bore(const Step& step, const Hole& hole);
};

}  // namespace steadyrest::nc::interpret
