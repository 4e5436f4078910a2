// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/chatter/online/better_speed.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::supervisor {

/// Hands the vibration of each frame to the detector, sample by sample, with the spindle's speed on
/// a straight line from the last frame's to this one's, and keeps what was answered.
///
/// Only what is cut in feed is listened to; threads, taps and unfit frames are not. Bound: a second
/// of samples a frame, no allocation.
class ListeningStage {
 public:
  struct Config {
    double sample_rate_hz =
        10e3;               ///< what the detector was made for; frames of another are skipped
    double depth_mm = 0.0;  ///< of the cut; 0 = not known
  };

  ListeningStage(const Config& config, chatter::online::BetterSpeed better)
      : config_(config), better_(std::move(better)) {}

  const chatter::online::BetterSpeed::Output& update(const kernel::signal::Frame& frame,
                                                     bool fit) noexcept;
  void reset() noexcept;

 private:
  Config config_;
  chatter::online::BetterSpeed better_;
  chatter::online::BetterSpeed::Output out_;
  double last_rev_s_ = 0.0;
};

}  // namespace steadyrest::supervisor
