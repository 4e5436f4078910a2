// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <steadyrest/supervisor/listening_stage.hpp>

// The frame's vibration is a block of samples, one cycle long. The detector takes one sample at a
// time with the spindle speed at that instant, interpolated from frame to frame: a speed that
// jumped once per cycle would smear the tooth-passing lines that the detector removes.
namespace steadyrest::supervisor {

kernel::outcome::Result<ListeningStage> ListeningStage::make(const Config& config) {
  auto better = chatter::online::BetterSpeed::make(config.better);
  if (!better) {
    return std::unexpected(std::move(better.error()));
  }
  return ListeningStage(config, std::move(*better));
}

ListeningStage::State ListeningStage::state() const {
  return {.better = better_.state(), .out = out_, .last_rev_s = last_rev_s_};
}

void ListeningStage::restore(const State& state) noexcept {
  better_.restore(state.better);
  out_ = state.out;
  last_rev_s_ = state.last_rev_s;
}

void ListeningStage::take_over(ListeningStage& before) noexcept {
  better_.take_over(before.better_);
  out_ = before.out_;
  last_rev_s_ = before.last_rev_s_;
}

void ListeningStage::reset() noexcept {
  better_.reset();
  out_ = {};
  last_rev_s_ = 0.0;
}

const chatter::online::BetterSpeed::Output& ListeningStage::update(
    const kernel::signal::Frame& frame, bool fit) noexcept {
  const double now_rev_s = std::abs(frame.spindle_actual_rev_s);
  const double before_rev_s = last_rev_s_ > 0.0 ? last_rev_s_ : now_rev_s;
  last_rev_s_ = now_rev_s;
  // The detector's windows are counted in samples: another sample rate would scale every frequency.
  // Threads, taps and air are not judged.
  const bool known_rate =
      std::abs(frame.vibration_rate_hz - sample_rate_hz_) <= 1e-6 * sample_rate_hz_;
  if (!fit || !known_rate || frame.motion != kernel::signal::Motion::feed) {
    return out_;
  }
  // A second of samples bounds the loop, whatever a port delivers.
  const auto most = static_cast<std::size_t>(sample_rate_hz_);
  const std::size_t count = std::min(frame.vibration.size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(count);
    out_ = better_.update({.value = frame.vibration[i],
                           .speed_rev_s = before_rev_s + share * (now_rev_s - before_rev_s),
                           .programmed_rev_s = std::abs(frame.spindle_programmed_rev_s),
                           .ratio = frame.spindle.effective_ratio,
                           .depth_mm = depth_mm_});
  }
  return out_;
}

}  // namespace steadyrest::supervisor
