// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/chatter/online/better_speed.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::supervisor {

/// Hands each frame's vibration to the detector, sample by sample, with the spindle speed
/// interpolated linearly from the last frame to this one, and keeps the answer.
///
/// The speed table is queried from the ratio that the control reports: the sound was made at that
/// one, not at the one on its way.
/// It listens only to feed cuts, not to threads, taps or unfit frames. Bound: a second of samples
/// per frame, no allocation.
class ListeningStage {
 public:
  struct Config {
    chatter::online::BetterSpeed::Config better;  ///< frames of another sample rate are skipped
    double depth_mm = 0.0;                        ///< of the cut; 0 = not known
    bool acts = true;  ///< the supervisor follows its request; else it is heard and shown alone
  };

  struct State {
    chatter::online::BetterSpeed::State better;
    chatter::online::BetterSpeed::Output out;
    double last_rev_s = 0.0;
  };

  /// Refuses what BetterSpeed refuses.
  [[nodiscard]] static kernel::outcome::Result<ListeningStage> make(const Config& config);

  const chatter::online::BetterSpeed::Output& update(const kernel::signal::Frame& frame,
                                                     bool fit) noexcept;
  void reset() noexcept;
  [[nodiscard]] State state() const;
  /// From a stage with the same config.
  void restore(const State& state) noexcept;
  /// As BetterSpeed::take_over().
  void take_over(ListeningStage& before) noexcept;
  [[nodiscard]] bool acts() const noexcept { return acts_; }

 private:
  ListeningStage(const Config& config, chatter::online::BetterSpeed better)
      : sample_rate_hz_(config.better.detector.sample_rate_hz),
        depth_mm_(config.depth_mm),
        acts_(config.acts),
        better_(std::move(better)) {}

  double sample_rate_hz_;
  double depth_mm_;
  bool acts_;
  chatter::online::BetterSpeed better_;
  chatter::online::BetterSpeed::Output out_;
  double last_rev_s_ = 0.0;
};

}  // namespace steadyrest::supervisor
