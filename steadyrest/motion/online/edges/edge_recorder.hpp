// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// The recorder: from what an encoder input gives to edges with their times.
///
/// This header stands alone: freestanding C++20, integers only, no allocation, no division, fit for
/// a microcontroller (-ffreestanding -fno-exceptions -fno-rtti). Cells and lines are those of
/// `estimator.hpp`: line k is the border between the cells k − 1 and k, so that
///   up   from cell c passes line c + 1, which is the new count;
///   down from cell c passes line c,     which is the old count,
/// and up over line k followed by down over line k names the same k twice.
///
/// Two front ends give the same events, for an `EdgeRing`:
///   QuadratureDecoder  levels A, B, sampled with a clock            → every edge
///   LatchedDecoder     count and time of the last edge, once a cycle → the last edge of each cycle
/// The counters are never reset. The clock in `EdgeEvent::ticks` is unwrapped, monotone, in ticks
/// of the input's own clock; its zero is where the clock stood at the first call.
namespace steadyrest::motion::online {

/// What is not certain about an event.
inline constexpr std::uint8_t kTimeUnknown = 1;     ///< `ticks` says only "not later than"
inline constexpr std::uint8_t kLineGuessed = 2;     ///< line and direction are the likelier of two
inline constexpr std::uint8_t kCountUncertain = 4;  ///< the counter may have wrapped unseen

/// The axis passed a line.
struct EdgeEvent {
  std::int64_t line = 0;
  std::uint64_t ticks = 0;     ///< unwrapped clock
  std::uint32_t lost = 0;      ///< at least so many edges before this one are missing (saturates)
  std::int8_t direction = 1;   ///< +1, −1
  std::uint8_t uncertain = 0;  ///< kTimeUnknown | kLineGuessed | kCountUncertain
};

namespace detail {

/// to − from of two counters of `bits` (1…64) bits, as the nearest of the possible values.
[[nodiscard]] constexpr std::int64_t wrapped_difference(std::uint64_t to, std::uint64_t from,
                                                        unsigned bits) noexcept {
  const unsigned shift = 64U - bits;
  return static_cast<std::int64_t>((to - from) << shift) >> shift;
}

[[nodiscard]] constexpr std::uint64_t mask(unsigned bits) noexcept {
  return ~std::uint64_t{0} >> (64U - bits);
}

[[nodiscard]] constexpr unsigned width(unsigned bits) noexcept {
  return bits < 1 ? 1U : (bits > 64 ? 64U : bits);
}

/// Counters wrap, also at the ends of 64 bits.
[[nodiscard]] constexpr std::int64_t wrapping_sum(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

[[nodiscard]] constexpr std::uint64_t magnitude(std::int64_t value) noexcept {
  const auto bits = static_cast<std::uint64_t>(value);
  return value < 0 ? std::uint64_t{0} - bits : bits;
}

constexpr void add_saturated(std::uint32_t& sum, std::uint64_t more) noexcept {
  const std::uint64_t room = ~std::uint32_t{0} - std::uint64_t{sum};
  sum = more > room ? ~std::uint32_t{0} : sum + static_cast<std::uint32_t>(more);
}

}  // namespace detail

/// Four edges per period from the sampled levels A and B; A leads when the axis moves upwards:
/// (A, B) = 00 → 10 → 11 → 01 → 00.
///
/// Filter: a level counts when it has held `hold_samples` samples; the edge's time is that of the
/// first of them, so the filter delays the report and never the stamp. A level lasts two counts, so
/// at most 2·(sampling rate)/hold_samples counts/s pass it.
///
/// Illegal transition (A and B in one sample): two edges happened, one unseen. The count goes on by
/// two in the last direction, or upwards when there was none; the event is the second edge, `lost`
/// counts the first, kLineGuessed is set. If the axis had turned in that very sample, the count is
/// wrong by four from there on, a whole period, and only an index mark can tell; count mod 4 agrees
/// with the levels always.
///
/// The stamp is that of the sample: an edge lies up to one sampling period before it.
class QuadratureDecoder {
 public:
  struct Config {
    unsigned clock_bits = 64;        ///< 1…64; the clock must not wrap between two samples
    std::uint16_t hold_samples = 1;  ///< ≥ 1; 1 = no filter
    bool reversed = false;           ///< B leads when the axis moves upwards
  };
  struct Channel {
    bool level = false;
    std::uint16_t held = 0;   ///< samples that the other level has held
    std::uint64_t since = 0;  ///< its first sample
  };
  /// Plain values, to be logged and restored.
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
  /// What is out of range is put at its limit.
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
  /// Place in the period: 00 → 10 → 11 → 01.
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

/// What an input with a latch gives once a cycle.
struct LatchedRead {
  std::uint64_t count = 0;     ///< raw
  std::uint64_t stamp = 0;     ///< raw time of the last edge
  std::uint64_t clock = 0;     ///< raw time of this read, of the same clock
  std::uint64_t cycle = 0;     ///< coarse counter that goes on when reads are missed
  std::int8_t direction = 0;   ///< of the last edge, where the hardware tells: ±1; 0: it does not
  bool stamp_invalid = false;  ///< the hardware says that the stamp means nothing
  bool overflowed = false;     ///< the stamp's timer ran over: it counts only if the count changed
  bool turned = false;         ///< the hardware says that the axis turned within the cycle
};

/// One event for each read in which an edge happened: the last edge.
///
/// Δ = change of the count, c = the new count, d = direction of the last edge:
///   line = c where d = +1, c + 1 where d = −1;
///   lost = |Δ| − 1 where d has the sign of Δ, else |Δ| + 1 (there and back; more pairs may be
///   lost).
/// Δ = 0 with a new stamp is an even number of edges: dither on a line, or a turn.
///
/// Where the hardware does not tell d it is the sign of Δ, and for Δ = 0 that of the event before
/// (the same line again). That is certain for |Δ| ≥ n as long as |acceleration| < 2n counts/cycle²:
/// an axis that passes lines k … k + n, turns and passes k + n again within one cycle T started at
/// line k with v² = u² + 2·A·n, u ≥ 0 being its speed over line k + n, and took
/// (√(u² + 2An) + u)/A ≥ √(2n/A) for it. `certain_from` is n; below it kLineGuessed is set: the
/// event is then wrong after every turn over a fresh line, so who gives bounds must not use it.
///
/// Time. The age of the edge, (clock − stamp) mod 2^bits, is right as long as the last read lies
/// less than half of the stamp's range back; `cycle` tells when it does not, and the event has
/// kTimeUnknown instead of one of several possible times. The clock itself is carried on over the
/// gap by `cycle`·`cycle_ticks`, to be right within half a wrap. An age beyond the time since the
/// last read is impossible and gives kTimeUnknown as well.
class LatchedDecoder {
 public:
  struct Config {
    unsigned count_bits = 32;    ///< 1…64, fraction included
    unsigned fraction_bits = 0;  ///< below the count: micro increments, which are cut off
    unsigned clock_bits = 64;    ///< 1…64, of stamp and clock
    unsigned stamp_bits = 0;     ///< range in which a stamp is unique, if narrower; 0 = clock_bits
    std::uint64_t cycle_ticks = 0;   ///< clock ticks per unit of `cycle`, about; 0: no such counter
    std::uint64_t ahead_ticks = 0;   ///< a stamp may be so much later than `clock` (read before it)
    std::uint64_t fuzz_ticks = 0;    ///< stamps so close are the same edge (stamps made from ages)
    std::uint64_t certain_from = 1;  ///< n; ⌊A·T²/(2·count)⌋ + 1
    std::uint64_t counts_per_cycle = 0;  ///< that the axis can make at most; 0: not checked
  };
  /// Plain values, to be logged and restored.
  struct State {
    bool started = false;
    std::uint64_t raw_count = 0;
    std::uint64_t stamp = 0;
    std::uint64_t cycle = 0;
    std::uint64_t clock_ticks = 0;  ///< unwrapped, of the last read
    std::uint64_t now_ticks = 0;    ///< the same, but not before an edge that was reported
    std::uint64_t edge_ticks = 0;   ///< of the last event
    std::int64_t count = 0;
    std::int8_t direction = 0;
    std::uint32_t gaps = 0;        ///< reads that came too late for their stamps
    std::uint32_t impossible = 0;  ///< stamps older than the last read
    std::uint32_t guessed = 0;     ///< events whose line is not certain
  };

  constexpr LatchedDecoder() noexcept = default;
  /// What is out of range is put at its limit.
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

  /// One read; true when an edge happened since the last one.
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

  /// The unwrapped time nearest to what the coarse counter expects; ticks since the last read.
  constexpr std::uint64_t advance_clock(const LatchedRead& read, std::uint64_t cycles) noexcept {
    const unsigned bits = config_.clock_bits;
    std::uint64_t elapsed = (read.clock - state_.clock_ticks) & detail::mask(bits);
    if (bits == 64) {
      elapsed = static_cast<std::int64_t>(elapsed) < 0 ? 0 : elapsed;  // ran backwards: stand
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
    // The micro increments of the sum must not be cut off twice: the sum is kept by whole counts.
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
    // A cycle's edges come before its tick, also where the clock was read first.
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
