// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// The programmed frame of sinumerik: TRANS, ATRANS, ROT and AROT about Z.
///
///   machine = settable offset + fine offset + Rs·(shift + Rp·position) + tool
///
/// TRANS and ROT replace the programmed frame; ATRANS and AROT build on it, so ATRANS shifts along
/// the rotated axes.
class Frames : private Stage {
 public:
  using Stage::Stage;

  bool set(const Step& step);
  /// $P_IFRAME[X,FI]: "The written settable frame is immediately included in the calculation"; the
  /// programmed frame stays, and the next G54 … loads the stored value ($P_UIFR). It moves nothing.
  bool set_fine(const read::Word& word);
  /// $P_UIFR[n]=…: the stored frame of G54 …, which acts when it is next selected; $P_PFRAME=…: the
  /// programmed frame, which acts at once.
  bool set_stored(const read::Block& block);
  /// A setting of the control (42440) decides whether an increment after a new frame includes the
  /// frame's shift, so the axis must first be programmed absolutely; after a rotation X and Y
  /// together.
  bool settle(const Step& step);

 private:
  struct Written;
  bool read_written(const read::Block& block, Written& written);
  bool store(const read::Word& head, const Written& written);
  bool add_rotation(const Step& step, double& angle_deg);
};

}  // namespace steadyrest::nc::interpret
