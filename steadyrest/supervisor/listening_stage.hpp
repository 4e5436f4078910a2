// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/chatter/online/better_speed.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::supervisor {

/// Hands the vibration of each frame to the detector, sample by sample, with the spindle's speed on
/// a straight line from the last frame's to this one's, and keeps what was answered.
///
/// The ratio that the speed table is asked from is the one that the control shows: the sound was
/// made at that one, not at what is on its way.
/// Only what is cut in feed is listened to; threads, taps and unfit frames are not. Bound: a second
/// of samples a frame, no allocation.
class ListeningStage {
 public:
  struct Config {
    chatter::online::BetterSpeed::Config better;  ///< frames of another sample rate are skipped
    double depth_mm = 0.0;                        ///< of the cut; 0 = not known
  };

  struct State {
    chatter::online::BetterSpeed::State better;
    chatter::online::BetterSpeed::Output out;
    double last_rev_s = 0.0;
  };

  /// Refuses what BetterSpeed refuses.
  [[nodiscard]] static kernel::outcome::Result<ListeningStage> make(Config config);

  const chatter::online::BetterSpeed::Output& update(const kernel::signal::Frame& frame,
                                                     bool fit) noexcept;
  void reset() noexcept;
  [[nodiscard]] State state() const;
  /// Of one that was made from the same config.
  void restore(const State& state) noexcept;

 private:
  ListeningStage(double sample_rate_hz, double depth_mm, chatter::online::BetterSpeed better)
      : sample_rate_hz_(sample_rate_hz), depth_mm_(depth_mm), better_(std::move(better)) {}

  double sample_rate_hz_;
  double depth_mm_;
  chatter::online::BetterSpeed better_;
  chatter::online::BetterSpeed::Output out_;
  double last_rev_s_ = 0.0;
};

}  // namespace steadyrest::supervisor
