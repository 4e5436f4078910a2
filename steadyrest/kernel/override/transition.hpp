// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/table.hpp>

/// Safe change between two steps of an override switch.
///
/// Law: while the bits in which code(from) and code(to) differ change one after another, in any
/// order, a reader may see each of the 2^k words that mix them. The change is safe when every one
/// of these words is in the table with a ratio inside [ratio(from), ratio(to)]. One bit (Gray
/// neighbours) is always safe; a binary carry (0111 → 1000) mixes 16 words and is not.
namespace steadyrest::kernel::override {

/// The change in one go, seen bit by bit, shows nothing outside [from, to]. O(steps).
[[nodiscard]] bool change_is_safe(const Table& table, std::size_t from, std::size_t to) noexcept;

/// Checks that each change between neighbours is safe, so that any change may be walked; the
/// refusal names the first unsafe pair.
[[nodiscard]] outcome::Result<void> check_walk(const Table& table);

/// Brings the word of one override switch from step to step.
///
/// A latched word takes effect as a whole and goes to its target at once. Any other word walks from
/// neighbour to neighbour and stays at each for one scan period, so that at most one bit changes
/// per scan. Works on step numbers; ratio and code come from the table. Time comes in as the good
/// time of each cycle, so that no clock fault can shorten the wait or stop it.
class Stepper {
 public:
  struct Config {
    bool latched = true;          ///< the word takes effect as a whole
    double scan_period_s = 0.01;  ///< s, ≥ 0: the reader looks this often
  };

  struct State {
    std::size_t step = 0;
    double stood_s = 0.0;  ///< good time since the last change
    bool written = false;  ///< the first word has been sent; the word before it is not known
    bool changed = true;   ///< no time has passed since: not settled, even without a scan
  };

  /// Refuses a word that is neither latched nor safe to walk, and a time that is not finite or < 0.
  [[nodiscard]] static outcome::Result<Stepper> make(const Table& table, const Config& config);

  /// A cycle has passed: the word then on the wires has been there `step_s` longer. The first cycle
  /// only marks that a word is written from now on.
  void pass(double step_s) noexcept;
  /// The step whose word is to be written now.
  std::size_t update(std::size_t target) noexcept;

  /// Puts the word at a step at once: allowed only while nothing reads it (the mask is off).
  void place(std::size_t step) noexcept;
  /// Marks a change of something that belongs to the word (the mask): the next change waits.
  void touch() noexcept {
    state_.stood_s = 0.0;
    state_.changed = true;
  }
  /// The word has been unchanged for a whole scan: every reader has seen it.
  [[nodiscard]] bool settled() const noexcept;

  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// A step beyond the table becomes its last; an invalid wait starts over.
  void restore(const State& state) noexcept;

 private:
  Stepper(std::size_t steps, const Config& config) noexcept : config_(config), steps_(steps) {}

  Config config_;
  std::size_t steps_;
  State state_;
};

}  // namespace steadyrest::kernel::override
