// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include <steadyrest/motion/online/edges/edge_inputs.hpp>

/// A board that latches count and clock at the edges of random cycles.
namespace steadyrest::motion::online::test {

/// An encoder input with a latch, and the truth: the brute-force reference. It keeps every edge
/// while the decoder sees one read per cycle, so every answer can be checked.
class Input {
 public:
  Input(unsigned count_bits, unsigned clock_bits, std::int64_t cell, std::uint64_t now)
      : count_bits_(count_bits), clock_bits_(clock_bits), cell_(cell), now_(now), edge_at_(now) {}

  void wait(std::uint64_t ticks) { now_ += ticks; }
  void pass(int direction) {
    // As counters do it: the count wraps, also at the ends of 64 bits.
    const auto cell = static_cast<std::uint64_t>(cell_);
    cell_ = static_cast<std::int64_t>(direction > 0 ? cell + 1U : cell - 1U);
    line_ = static_cast<std::int64_t>(direction > 0 ? cell + 1U : cell);
    direction_ = static_cast<std::int8_t>(direction);
    edge_at_ = now_;
    ++edges_;
  }
  [[nodiscard]] LatchedRead read(std::uint64_t cycle, bool tells_direction) const {
    return {.count = static_cast<std::uint64_t>(cell_) & detail::mask(count_bits_),
            .stamp = edge_at_ & detail::mask(clock_bits_),
            .clock = now_ & detail::mask(clock_bits_),
            .cycle = cycle,
            .direction = tells_direction ? direction_ : std::int8_t{0}};
  }
  [[nodiscard]] std::int64_t cell() const { return cell_; }
  [[nodiscard]] std::int64_t line() const { return line_; }
  [[nodiscard]] std::int8_t direction() const { return direction_; }
  [[nodiscard]] std::uint64_t edge_at() const { return edge_at_; }
  [[nodiscard]] std::uint64_t now() const { return now_; }
  [[nodiscard]] std::uint64_t edges() const { return edges_; }

 private:
  unsigned count_bits_;
  unsigned clock_bits_;
  std::int64_t cell_;
  std::int64_t line_ = 0;
  std::int8_t direction_ = 0;
  std::uint64_t now_;
  std::uint64_t edge_at_;
  std::uint64_t edges_ = 0;
};

inline constexpr std::uint64_t kCycle = 2000;

/// One cycle of a random walk: 0…4 edges at random instants.
/// Cycles jitter by ± 2.5 %, edges keep apart.
inline void random_cycle(Input& input, std::mt19937_64& random) {
  std::uint64_t left = kCycle + random() % 101 - 50;
  for (std::uint64_t n = random() % 5; n > 0; --n) {
    const std::uint64_t step = 1 + random() % (left / 6);
    input.wait(step);
    left -= step;
    input.pass((random() & 1U) != 0 ? 1 : -1);
  }
  input.wait(left);
}

}  // namespace steadyrest::motion::online::test
