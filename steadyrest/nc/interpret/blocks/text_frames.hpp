// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// The fanuc family's frames in the words: mirror image (G51.1, G50.1), scaling (G51, G50),
/// rotation (G68, G69), polar coordinates (G16, G15). FANUC Series 30i operator's manual, machining
/// centre system; Haas mill operator's manual.
class TextFrames : private Stage {
 public:
  using Stage::Stage;

  /// What a block may have beneath a frame. Call before it acts.
  bool permits(const Step& step);
  /// What the block says of frames.
  bool set(const Step& step);
  /// Before a block moves: where the axes are after a change of rotation is not certain until both
  /// axes of its plane have been programmed absolutely.
  bool settle(const Step& step);

 private:
  bool scaling(const Step& step);
  bool mirror(const Step& step);
  bool rotation(const Step& step);
  bool only(const Step& step, std::uint32_t letters);
  void end_rotation() noexcept;
};

}  // namespace steadyrest::nc::interpret
