// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// What the envelope has let through of one override; 1.0 = 100 %.
struct RatioInForce {
  double ratio = 1.0;  ///< after clamp, slew and panel, before the steps of the table
  /// What the control was told: the word's step where it masks the panel, else the panel's ratio.
  /// It acts a scan and a dead time later.
  double word_ratio = 1.0;
};

/// What the envelope let through in the cycle before. It comes down to the rooms with the next
/// frame, so that none of them has to guess what became of its requests.
///
/// In act it is what the port was told, less what the port refused; in advise what it would have
/// been told; in observe the panel's ratios and no offset.
struct InForce {
  RatioInForce feed{};
  RatioInForce spindle{};
  AxisValues offset_mm{};
  bool written = false;  ///< it is on the machine: mode act, and the port can be written
};

}  // namespace steadyrest::kernel::signal
