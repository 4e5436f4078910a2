// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/motion/online/edges/edge_event.hpp>

namespace steadyrest::motion::online {

/// Four edges per period from the sampled levels A and B; A leads when the axis moves upwards:
/// (A, B) = 00 → 10 → 11 → 01 → 00.
///
/// Filter: a level counts once it has lasted `hold_samples` samples; the edge's time is that of the
/// first of them, so the filter delays the report but never the stamp. A level lasts two counts, so
/// at most 2·(sampling rate)/hold_samples counts/s pass the filter.
///
/// Illegal transition (A and B in one sample): two edges occurred, one unseen. The count moves by
/// two in the last direction, or upwards if there was none; the event is the second edge, `lost`
/// counts the first, kLineGuessed is set. If the axis turned in that very sample, the count is
/// wrong by four from then on, a whole period, and only an index mark can tell; count mod 4 always
/// agrees with the levels.
///
/// The stamp is that of the sample: the edge is up to one sampling period earlier.
class QuadratureDecoder {
 public:
  struct Config {
    unsigned clock_bits = 64;        ///< 1…64; the clock must not wrap between two samples
    std::uint16_t hold_samples = 1;  ///< ≥ 1; 1 = no filter
    bool reversed = false;           ///< B leads when the axis moves upwards
  };
  struct Channel {
    bool level = false;
    std::uint16_t held = 0;   ///< samples for which the other level has lasted
    std::uint64_t since = 0;  ///< its first sample
  };
  /// Plain values, for logging and restoring.
  struct State {
    bool started = false;
    Channel a, b;
    std::uint64_t clock = 0;  ///< raw, of the last sample
    std::uint64_t ticks = 0;
    std::int64_t count = 0;
    std::int8_t direction = 0;  ///< 0: none yet
    std::uint32_t glitches = 0;
    std::uint32_t illegal = 0;  ///< transitions
  };

  constexpr QuadratureDecoder() noexcept = default;
  /// Values out of range are set to their limit.
  constexpr explicit QuadratureDecoder(const Config& config) noexcept
      : bits_(detail::width(config.clock_bits)),
        hold_(config.hold_samples < 1 ? std::uint16_t{1} : config.hold_samples),
        up_(config.reversed ? 3U : 1U) {}

  /// One sample at the raw time `clock`; true when it completes an edge.
  constexpr bool update(bool a, bool b, std::uint64_t clock, EdgeEvent& event) noexcept {
    if (!state_.started) {
      state_.started = true;
      state_.a.level = a;
      state_.b.level = b;
      state_.clock = clock;
      state_.ticks = clock & detail::mask(bits_);
      return false;
    }
    state_.ticks += (clock - state_.clock) & detail::mask(bits_);
    state_.clock = clock;
    const unsigned before = phase();
    const bool a_changed = settle(state_.a, a);
    const bool b_changed = settle(state_.b, b);
    if (!a_changed && !b_changed) {
      return false;
    }
    pass((phase() - before) & 3U, event);
    event.ticks = a_changed ? state_.a.since : state_.b.since;
    return true;
  }

  [[nodiscard]] constexpr std::int64_t count() const noexcept { return state_.count; }
  [[nodiscard]] constexpr std::uint64_t ticks() const noexcept { return state_.ticks; }
  [[nodiscard]] constexpr const State& state() const noexcept { return state_; }
  constexpr void restore(const State& state) noexcept { state_ = state; }

 private:
  /// Position in the period: 00 → 10 → 11 → 01.
  [[nodiscard]] constexpr unsigned phase() const noexcept {
    return state_.a.level ? (state_.b.level ? 2U : 1U) : (state_.b.level ? 3U : 0U);
  }

  constexpr bool settle(Channel& channel, bool level) noexcept {
    if (level == channel.level) {
      state_.glitches += channel.held != 0 ? 1U : 0U;
      channel.held = 0;
      return false;
    }
    if (channel.held == 0) {
      channel.since = state_.ticks;
    }
    ++channel.held;
    if (channel.held < hold_) {
      return false;
    }
    channel.level = level;
    channel.held = 0;
    return true;
  }

  constexpr void pass(unsigned turn, EdgeEvent& event) noexcept {
    const bool illegal = turn == 2U;
    if (!illegal) {
      state_.direction = turn == up_ ? std::int8_t{1} : std::int8_t{-1};
    } else if (state_.direction == 0) {
      state_.direction = 1;
    }
    state_.illegal += illegal ? 1U : 0U;
    const std::int64_t last_cell = state_.count + (illegal ? state_.direction : std::int8_t{0});
    state_.count = detail::wrapping_sum(last_cell, state_.direction);
    event.line = state_.direction > 0 ? state_.count : last_cell;
    event.direction = state_.direction;
    event.lost = illegal ? 1U : 0U;
    event.uncertain = illegal ? kLineGuessed : std::uint8_t{0};
  }

  unsigned bits_ = 64;
  std::uint16_t hold_ = 1;
  unsigned up_ = 1;
  State state_;
};

}  // namespace steadyrest::motion::online
