// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/cycle/drilling.hpp>

namespace steadyrest::nc::interpret {

/// Haas G70 and G71: holes on a circle or an arc about the tool's place, or the place that the
/// block names, by the drilling cycle of the block or in force. Hole k of G70 is at the angle J +
/// k·360°/L, of G71 at J + k·K, radius I, counter-clockwise from +X; a negative I turns G70 round.
/// Haas mill operator's manual, "Bolt hole circle", "Bolt hole arc".
class HolePatterns : private Stage {
 public:
  HolePatterns(Control& control, MoveOutput& out, Drilling& drilling) noexcept
      : Stage(control, out), drilling_(drilling) {}

  bool drill(const Step& step);

 private:
  Drilling& drilling_;
};

}  // namespace steadyrest::nc::interpret
