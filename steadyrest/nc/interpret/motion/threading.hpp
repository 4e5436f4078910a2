// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// G33, G33.1 and G76: the feed follows the spindle.
class Threading : private Stage {
 public:
  using Stage::Stage;

  /// G33; G33.1 reverses the spindle at the end and retracts.
  bool thread(const Step& step);
  /// sinumerik G331 and G332: in, or out again, with the spindle as an axis.
  bool tap(const Step& step);
  /// G76.
  bool cycle(const Step& step);

 private:
  struct Cycle;
  bool spindle_turns(const Step& step);
  bool read(const Step& step, Cycle& cycle);
  bool is_possible(const Step& step, const Cycle& cycle);
  void pass(const Cycle& cycle, double depth_mm);
  void emit(const Axes& end, double pitch_mm);
};

}  // namespace steadyrest::nc::interpret
