// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/transition.hpp>

// A word of several bits on separate wires changes bit by bit, and a PLC may read it in between. A
// change is safe if each of these 2^k mixtures is a code of the table with a ratio between the two
// ends.
namespace steadyrest::kernel::override {
namespace {

constexpr double kTimeTolerance = 1e-9;  // s: rounding of summed cycles

outcome::Refusal not_walkable(const Table& table, std::size_t from, std::size_t to) {
  return outcome::bad_input(
      fmt::format(
          "override codes {:#b} ({:g} %) and {:#b} ({:g} %) differ in {} bits: a PLC that sees "
          "them change one by one reads a value that is neither",
          table.code(from), 100.0 * table.ratio(from), table.code(to), 100.0 * table.ratio(to),
          std::popcount(table.code(from) ^ table.code(to))),
      "use a port that latches the whole word, or a Gray table");
}

}  // namespace

// Counted over the table instead of over the mixtures: the cost is the table's length, not 2^k.
bool change_is_safe(const Table& table, std::size_t from, std::size_t to) noexcept {
  const std::uint32_t differing = table.code(from) ^ table.code(to);
  const auto [lowest, highest] = std::minmax({table.ratio(from), table.ratio(to)});
  std::uint64_t inside = 0;
  for (std::size_t step = 0; step < table.steps(); ++step) {
    const bool mixture = ((table.code(step) ^ table.code(from)) & ~differing) == 0;
    if (mixture && table.ratio(step) >= lowest && table.ratio(step) <= highest) {
      ++inside;
    }
  }
  // Codes are distinct: all words are good exactly when 2^k good codes are among them.
  return inside == std::uint64_t{1} << static_cast<unsigned>(std::popcount(differing));
}

// A walk needs neighbours only; without a latch no word ever jumps.
outcome::Result<void> check_walk(const Table& table) {
  for (std::size_t step = 1; step < table.steps(); ++step) {
    if (!change_is_safe(table, step - 1, step)) {
      return std::unexpected(not_walkable(table, step - 1, step));
    }
  }
  return {};
}

outcome::Result<Stepper> Stepper::make(const Table& table, const Config& config) {
  if (!std::isfinite(config.scan_period_s) || config.scan_period_s < 0.0) {
    return outcome::refuse(
        fmt::format("scan period is {} s; allowed: finite and ≥ 0", config.scan_period_s),
        "give the period at which the override word is read");
  }
  if (!config.latched) {
    if (auto walk = check_walk(table); !walk) {
      return std::unexpected(walk.error());
    }
  }
  return Stepper(table.steps(), config);
}

// Time before the first write does not count: the layer had nothing on the wires.
void Stepper::pass(double step_s) noexcept {
  // Only good time counts: no clock fault may shorten the wait.
  if (state_.written && std::isfinite(step_s) && step_s > 0.0) {
    state_.stood_s += step_s;
    state_.changed = false;
  }
  state_.written = true;
}

std::size_t Stepper::update(std::size_t target) noexcept {
  target = std::min(target, steps_ - 1);
  if (config_.latched) {
    place(target);
  } else if (target != state_.step && settled()) {
    // One neighbour per scan, so that at most one bit moves while anyone looks.
    place(target > state_.step ? state_.step + 1 : state_.step - 1);
  }
  return state_.step;
}

void Stepper::place(std::size_t step) noexcept {
  step = std::min(step, steps_ - 1);
  if (step != state_.step) {
    state_.step = step;
    touch();
  }
}

// A word is settled after a whole scan on the wires since its last change.
bool Stepper::settled() const noexcept {
  return config_.latched ||
         (!state_.changed && state_.stood_s >= config_.scan_period_s - kTimeTolerance);
}

// The table may have fewer steps than when the state was written.
void Stepper::restore(const State& state) noexcept {
  state_ = state;
  state_.step = std::min(state_.step, steps_ - 1);
  if (!(std::isfinite(state_.stood_s) && state_.stood_s >= 0.0)) {
    state_.stood_s = 0.0;
  }
}

}  // namespace steadyrest::kernel::override
