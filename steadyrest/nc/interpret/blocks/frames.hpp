// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// The programmed frame of sinumerik: TRANS, ATRANS, ROT and AROT about Z.
///
///   machine = settable offset + fine offset + Rs·(shift + Rp·position) + tool
///
/// TRANS and ROT delete the programmed frame before; ATRANS and AROT build on it, so that ATRANS
/// goes along the turned axes.
class Frames : private Stage {
 public:
  using Stage::Stage;

  bool set(const Step& step);
  /// $P_IFRAME[X,FI]: "The written settable frame is immediately included in the calculation"; the
  /// programmed frame stays, and the next G54 … takes what is stored ($P_UIFR). It moves nothing.
  bool set_fine(const read::Word& word);
  /// Whether an increment behind a new frame contains the frame's shift is a setting of the control
  /// (42440), so the axis must be programmed absolutely first; after a rotation X and Y together.
  bool settle(const Step& step);
};

}  // namespace steadyrest::nc::interpret
