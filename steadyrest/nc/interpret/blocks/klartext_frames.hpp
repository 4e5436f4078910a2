// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Coordinate transformations of `heidenhain`: CYCL DEF 7 (datum shift), 8 (mirroring), 10
/// (rotation), 11 (scaling, only by 1) and 247 (preset).
///
///   machine = preset + shift + R·M·position + tool
///
/// The result of several depends on the order in which they are programmed (TNC 640 user's manual,
/// "Working plane coordinate system"). A shift before a rotation or a mirroring is certain, and so
/// is what does not depend on it: another order, and a rotation together with a mirroring, is
/// refused.
class KlartextFrames : private Stage {
 public:
  using Stage::Stage;

  /// A line of CYCL DEF 7, 8, 10 or 11.
  bool set(const Step& step);
  /// CYCL DEF 247: shift, rotation and mirroring end.
  bool preset(const Step& step, double number);

 private:
  bool shift(const Step& step);
  bool mirror(const Step& step);
  bool rotate(const Step& step);
  void changed() noexcept;
};

}  // namespace steadyrest::nc::interpret
