// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// What the envelope let pass of one override; 1.0 = 100 %.
struct RatioInForce {
  double ratio = 1.0;  ///< after clamp, slew and panel, before the steps of the table
  /// What the control was told: the word's step where it masks the panel, else the panel's ratio.
  /// It takes effect a scan and a dead time later.
  double word_ratio = 1.0;
};

/// What the envelope let pass in the previous cycle. The next frame carries it down to the rooms,
/// so that none has to guess what became of its requests.
///
/// In act it is what the port was told, less what the port refused; in advise what the port would
/// have been told; in observe the panel's ratios and no offset.
struct InForce {
  RatioInForce feed{};
  RatioInForce spindle{};
  AxisValues offset_mm{};
  AxisValues path_offset_mm{};
  bool active = false;   ///< requests go somewhere: mode act or advise, and no interruption
  bool written = false;  ///< it is on the machine: mode act, and the port can write
};

}  // namespace steadyrest::kernel::signal
