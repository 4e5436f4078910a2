// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/motion/online/edges/edge_event.hpp>

namespace steadyrest::motion::online {

/// What a latching input delivers once per cycle.
struct LatchedRead {
  std::uint64_t count = 0;     ///< raw
  std::uint64_t stamp = 0;     ///< raw time of the last edge
  std::uint64_t clock = 0;     ///< raw time of this read, of the same clock
  std::uint64_t cycle = 0;     ///< coarse counter that keeps counting when reads are missed
  std::int8_t direction = 0;   ///< of the last edge if the hardware tells: ±1; else 0
  bool stamp_invalid = false;  ///< the hardware says that the stamp means nothing
  bool overflowed = false;     ///< the stamp's timer overflowed: valid only if the count changed
  bool turned = false;         ///< the hardware says that the axis turned within the cycle
};

/// One event for each read in which an edge occurred: the last edge.
///
/// Δ = change of the count, c = the new count, d = direction of the last edge:
///   line = c where d = +1, c + 1 where d = −1;
///   lost = |Δ| − 1 where d has the sign of Δ, else |Δ| + 1 (there and back; more pairs may be
///   lost).
/// Δ = 0 with a new stamp is an even number of edges: dither on a line, or a turn.
///
/// Where the hardware does not tell d, it is the sign of Δ, and for Δ = 0 that of the previous
/// event (the same line again). That is certain for |Δ| ≥ n as long as |acceleration| < 2n
/// counts/cycle²: an axis that passes lines k … k + n, turns and passes k + n again within one
/// cycle T started at line k with v² = u² + 2·A·n, u ≥ 0 being its speed over line k + n, and took
/// (√(u² + 2An) + u)/A ≥ √(2n/A) for it. `certain_from` is n; below it kLineGuessed is set: the
/// event is then wrong after every turn over a new line, so estimators with bounds must not use it.
///
/// Time. The age of the edge, (clock − stamp) mod 2^bits, is right as long as the last read is less
/// than half of the stamp's range ago; `cycle` tells when it is not, and the event then has
/// kTimeUnknown instead of one of several possible times. The clock itself is carried across the
/// gap by `cycle`·`cycle_ticks`, which must be right within half a wrap. An age beyond the time
/// since the last read is impossible and also gives kTimeUnknown.
class LatchedDecoder {
 public:
  struct Config {
    unsigned count_bits = 32;    ///< 1…64, fraction included
    unsigned fraction_bits = 0;  ///< below the count: micro increments, which are dropped
    unsigned clock_bits = 64;    ///< 1…64, of stamp and clock
    unsigned stamp_bits = 0;     ///< range in which a stamp is unique, if narrower; 0 = clock_bits
    std::uint64_t cycle_ticks = 0;   ///< clock ticks per unit of `cycle`, about; 0: no such counter
    std::uint64_t ahead_ticks = 0;   ///< how much later than `clock` (read first) a stamp may be
    std::uint64_t fuzz_ticks = 0;    ///< stamps this close are one edge (stamps made from ages)
    std::uint64_t certain_from = 1;  ///< n; ⌊A·T²/(2·count)⌋ + 1
    std::uint64_t counts_per_cycle = 0;  ///< most that the axis can make; 0: not checked
  };
  /// Plain values, for logging and restoring.
  struct State {
    bool started = false;
    std::uint64_t raw_count = 0;
    std::uint64_t stamp = 0;
    std::uint64_t cycle = 0;
    std::uint64_t clock_ticks = 0;  ///< unwrapped, of the last read
    std::uint64_t now_ticks = 0;    ///< the same, but not before a reported edge
    std::uint64_t edge_ticks = 0;   ///< of the last event
    std::int64_t count = 0;
    std::int8_t direction = 0;
    std::uint32_t gaps = 0;        ///< reads that came too late for their stamps
    std::uint32_t impossible = 0;  ///< stamps older than the last read
    std::uint32_t guessed = 0;     ///< events whose line is not certain
  };

  constexpr LatchedDecoder() noexcept = default;
  /// Values out of range are set to their limit.
  constexpr explicit LatchedDecoder(const Config& config) noexcept : config_(config) {
    config_.count_bits = detail::width(config.count_bits);
    config_.clock_bits = detail::width(config.clock_bits);
    const bool narrower = config.stamp_bits > 0 && config.stamp_bits < config_.clock_bits;
    config_.stamp_bits = narrower ? config.stamp_bits : config_.clock_bits;
    if (config_.fraction_bits >= config_.count_bits) {
      config_.fraction_bits = config_.count_bits - 1;
    }
    config_.certain_from = config.certain_from < 1 ? 1 : config.certain_from;
  }

  /// One read; true when an edge occurred since the last one.
  constexpr bool update(const LatchedRead& read, EdgeEvent& event) noexcept {
    if (!state_.started) {
      begin(read);
      return false;
    }
    const std::uint64_t cycles = cycles_since(read);
    const std::uint64_t elapsed = advance_clock(read, cycles);
    const std::int64_t change = advance_count(read);
    const std::uint64_t moved = distance(read.stamp, state_.stamp);
    const bool stamped = !read.stamp_invalid;
    const std::int64_t age = age_of(read.stamp);
    const bool fresh = age <= 0 || static_cast<std::uint64_t>(age) <= elapsed + config_.fuzz_ticks;
    const bool new_stamp = stamped && !read.overflowed && moved > config_.fuzz_ticks;
    state_.stamp = stamped ? read.stamp : state_.stamp;
    const bool late = elapsed > detail::mask(config_.stamp_bits) >> 1U;
    state_.gaps += late ? 1U : 0U;
    state_.impossible += (change != 0 || new_stamp) && stamped && !fresh ? 1U : 0U;
    if (change == 0 && (!new_stamp || !fresh)) {
      return false;
    }
    event = {};
    place(read, change, event);
    time(stamped && fresh && !late, age, event);
    if (count_may_have_wrapped(cycles)) {
      event.uncertain = static_cast<std::uint8_t>(event.uncertain | kCountUncertain);
    }
    return true;
  }

  [[nodiscard]] constexpr std::int64_t count() const noexcept { return state_.count; }
  /// Unwrapped time of the last read.
  [[nodiscard]] constexpr std::uint64_t ticks() const noexcept { return state_.now_ticks; }
  [[nodiscard]] constexpr const State& state() const noexcept { return state_; }
  constexpr void restore(const State& state) noexcept { state_ = state; }

 private:
  constexpr void begin(const LatchedRead& read) noexcept {
    state_.started = true;
    state_.raw_count = read.count;
    state_.count =
        detail::wrapped_difference(read.count, 0, config_.count_bits) >> config_.fraction_bits;
    state_.stamp = read.stamp;
    state_.cycle = read.cycle;
    state_.clock_ticks = read.clock & detail::mask(config_.clock_bits);
    state_.now_ticks = state_.clock_ticks;
  }

  [[nodiscard]] static constexpr std::uint64_t later(std::uint64_t a, std::uint64_t b) noexcept {
    return a > b ? a : b;
  }

  constexpr std::uint64_t cycles_since(const LatchedRead& read) noexcept {
    const auto cycles = static_cast<std::int64_t>(read.cycle - state_.cycle);
    state_.cycle = read.cycle;
    return cycles > 0 ? static_cast<std::uint64_t>(cycles) : 0U;
  }

  /// Advances to the unwrapped time nearest to the coarse counter's expectation; returns the ticks
  /// since the last read.
  constexpr std::uint64_t advance_clock(const LatchedRead& read, std::uint64_t cycles) noexcept {
    const unsigned bits = config_.clock_bits;
    std::uint64_t elapsed = (read.clock - state_.clock_ticks) & detail::mask(bits);
    if (bits == 64) {
      elapsed = static_cast<std::int64_t>(elapsed) < 0 ? 0 : elapsed;  // ran backwards: hold
    } else if (cycles * config_.cycle_ticks > elapsed) {
      const std::uint64_t expected = cycles * config_.cycle_ticks;
      const auto error = detail::wrapped_difference(elapsed, expected, bits);
      elapsed = expected + static_cast<std::uint64_t>(error);
    }
    state_.clock_ticks += elapsed;
    state_.now_ticks = later(state_.clock_ticks, state_.now_ticks);
    return elapsed;
  }

  constexpr std::int64_t advance_count(const LatchedRead& read) noexcept {
    // The micro increments of the sum must not be truncated twice: the sum is kept in whole counts.
    const unsigned fraction = config_.fraction_bits;
    const std::int64_t change = detail::wrapped_difference(
        read.count >> fraction, state_.raw_count >> fraction, config_.count_bits - fraction);
    state_.raw_count = read.count;
    state_.count = detail::wrapping_sum(state_.count, change);
    return change;
  }

  [[nodiscard]] constexpr std::uint64_t distance(std::uint64_t a, std::uint64_t b) const noexcept {
    return detail::magnitude(detail::wrapped_difference(a, b, config_.clock_bits));
  }

  /// Ticks from the edge to the read; negative where the stamp was latched after the clock.
  [[nodiscard]] constexpr std::int64_t age_of(std::uint64_t stamp) const noexcept {
    const std::uint64_t range = detail::mask(config_.clock_bits);
    const std::uint64_t age = (state_.clock_ticks - stamp) & range;
    const std::uint64_t ahead = (stamp - state_.clock_ticks) & range;
    if (ahead != 0 && ahead <= config_.ahead_ticks) {
      return -static_cast<std::int64_t>(ahead);
    }
    constexpr auto kMost = static_cast<std::uint64_t>(INT64_MAX);
    return static_cast<std::int64_t>(age > kMost ? kMost : age);
  }

  constexpr void place(const LatchedRead& read, std::int64_t change, EdgeEvent& event) noexcept {
    const auto sign = static_cast<std::int8_t>(change > 0 ? 1 : (change < 0 ? -1 : 0));
    const std::uint64_t steps = detail::magnitude(change);
    const auto likely = sign != 0 ? sign : state_.direction;
    event.direction =
        read.direction != 0 ? read.direction : (likely != 0 ? likely : std::int8_t{1});
    event.line = detail::wrapping_sum(state_.count, event.direction > 0 ? 0 : 1);
    detail::add_saturated(event.lost, event.direction == sign ? steps - 1 : steps + 1);
    if (read.direction == 0 && (steps < config_.certain_from || read.turned)) {
      event.uncertain = kLineGuessed;
      ++state_.guessed;
    }
    state_.direction = event.direction;
  }

  constexpr void time(bool known, std::int64_t age, EdgeEvent& event) noexcept {
    if (!known) {
      event.ticks = state_.now_ticks;
      state_.edge_ticks = event.ticks;
      event.uncertain = static_cast<std::uint8_t>(event.uncertain | kTimeUnknown);
      return;
    }
    const bool before_start = age > 0 && static_cast<std::uint64_t>(age) > state_.clock_ticks;
    const std::uint64_t ticks =
        before_start ? 0 : state_.clock_ticks - static_cast<std::uint64_t>(age);
    event.ticks = later(ticks, state_.edge_ticks);  // stamps made from ages may be off by one
    state_.edge_ticks = event.ticks;
    // A cycle's edges come before its tick, even where the clock was read first.
    state_.now_ticks = later(event.ticks, state_.now_ticks);
  }

  [[nodiscard]] constexpr bool count_may_have_wrapped(std::uint64_t cycles) const noexcept {
    const unsigned bits = config_.count_bits - config_.fraction_bits;
    return config_.counts_per_cycle > 0 &&
           cycles * config_.counts_per_cycle > detail::mask(bits) >> 1U;
  }

  Config config_{.stamp_bits = 64};
  State state_;
};

}  // namespace steadyrest::motion::online
