// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace steadyrest::kernel::machine {

/// The last step before any write; the layer cannot switch it off.
struct Envelope {
  double min_feed_ratio = 0.0;
  double max_feed_ratio = 1.2;
  double feed_fall_1_s = 10.0;  ///< slew limits of the ratio, per second
  double feed_rise_1_s = 2.0;
  double min_spindle_ratio = 0.5;
  double max_spindle_ratio = 1.2;
  double spindle_slew_1_s = 2.0;
  double max_offset_mm = 0.2;
  double offset_slew_mm_s = 0.05;
  /// Offsets that take the contour error away: how far they and the other offsets together may move
  /// an axis, and how fast they may change. 0: the control takes none.
  double max_path_offset_mm = 0.0;
  double path_offset_slew_mm_s = 50.0;
  double stale_after_s = 0.1;  ///< older input is ignored
  /// Late is not dead: the machine's side keeps the layer's word for so long after its last
  /// heartbeat, and only then lets it rise to the panel's (supervisor/README.md). Where a control's
  /// dead man or a watchdog of the wiring has a time of its own, that one counts.
  double late_hold_s = 1.0;

  friend bool operator==(const Envelope&, const Envelope&) = default;
};

}  // namespace steadyrest::kernel::machine
