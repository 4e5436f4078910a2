// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/test/hunted_override.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>

/// The safety claims that must hold in each cycle of a hunt, and the count of violations.
namespace steadyrest::chatter::online::test {

struct Hunt {
  std::uint64_t changes = 0;
  std::uint64_t wishes = 0;   ///< cycles with a request for the spindle
  std::uint64_t words = 0;    ///< changes of a masked word
  std::uint64_t outside = 0;  ///< a request outside the limits, or not neutral when it should be
  std::uint64_t phase_jumps = 0;
  std::uint64_t speed_jumps = 0;     ///< the swing moved faster than the drive
  std::uint64_t feed_per_tooth = 0;  ///< requested, or in force at the machine, above the band
  std::uint64_t invalid_codes = 0;
  std::uint64_t words_outside = 0;  ///< a mixture of two words decoded outside of [from, to]
  std::string first;                ///< what the first fault was

  [[nodiscard]] std::uint64_t faults() const {
    return outside + phase_jumps + speed_jumps + feed_per_tooth + invalid_codes + words_outside;
  }
  void add(const Hunt& part) {
    changes += part.changes;
    wishes += part.wishes;
    words += part.words;
    outside += part.outside;
    phase_jumps += part.phase_jumps;
    speed_jumps += part.speed_jumps;
    feed_per_tooth += part.feed_per_tooth;
    invalid_codes += part.invalid_codes;
    words_outside += part.words_outside;
    if (first.empty()) {
      first = part.first;
    }
  }
};

class Sentences {
 public:
  explicit Sentences(Modulator::Config config) : config_(std::move(config)) {}

  void fault(std::uint64_t& counter, const char* what, double seen) {
    ++counter;
    if (hunt.first.empty()) {
      hunt.first = fmt::format("change {}: {}: {:.17g}", hunt.changes, what, seen);
    }
  }

  void check_word(const HuntedOverride::Seen& seen) {
    if (seen.invalid) {
      fault(hunt.invalid_codes, "invalid code", seen.code);
    }
    if (seen.outside) {
      fault(hunt.words_outside, "a word decodes outside of [from, to]", *seen.outside);
    }
    hunt.words += seen.changed ? 1U : 0U;
  }

  /// `table` is the spindle's; `spoilt`: the frame is deliberately unfit.
  void check_request(const Modulator::Output& out, const kernel::signal::Frame& frame,
                     const kernel::override::Table& table, bool spoilt) {
    constexpr double kTolerance = 1e-9;
    for (const auto& [ratio, reason] : {std::pair{out.spindle.ratio, out.spindle.reason},
                                        std::pair{out.feed.ratio, out.feed.reason}}) {
      if (!std::isfinite(ratio) || (!kernel::override::is_wish(reason) && ratio != 1.0)) {
        fault(hunt.outside, "not neutral", ratio);
      }
    }
    if (out.active && spoilt && !std::isfinite(frame.time_s)) {
      fault(hunt.outside, "active on unfit input", frame.time_s);
    }
    if (kernel::override::is_wish(out.spindle.reason)) {
      ++hunt.wishes;
      const double ratio = out.spindle.ratio;
      const auto step = table.nearest_step(ratio);
      if (!step || table.ratio(*step) != ratio) {
        fault(hunt.outside, "no step of the table", ratio);
      }
      if (ratio < config_.min_ratio - kTolerance || ratio > config_.max_ratio + kTolerance) {
        fault(hunt.outside, "spindle outside of its limits", ratio);
      }
      const double speed = ratio * std::abs(frame.spindle_programmed_rev_s);
      const bool lowest = ratio <= table.ratio(*table.ceil_step(config_.min_ratio)) + kTolerance;
      if (speed > config_.max_rev_s * (1.0 + kTolerance) && !lowest) {
        fault(hunt.outside, "faster than the spindle can", speed);
      }
      if (!config_.spindle_table.layer_may_exceed_panel && !lowest &&
          ratio > frame.spindle.panel_ratio + kTolerance) {
        fault(hunt.outside, "above the panel", ratio);
      }
    }
    if (kernel::override::is_wish(out.feed.reason)) {
      const double ratio = out.feed.ratio;
      if (ratio < config_.min_feed_ratio - kTolerance ||
          ratio > config_.max_feed_ratio + kTolerance) {
        fault(hunt.outside, "feed outside of its limits", ratio);
      }
      const double shown = std::abs(frame.spindle_actual_rev_s / frame.spindle_programmed_rev_s);
      const double actual = std::max(shown, table.ratio(*table.ceil_step(config_.min_ratio)));
      if (shown > 1e-3 && ratio > config_.max_feed_per_tooth_ratio * actual + 1e-6) {
        fault(hunt.feed_per_tooth, "feed per tooth above its band", ratio / actual);
      }
    }
  }

  /// From one cycle's state to the next; `panel_ratio` is the true position of the operator's
  /// switch.
  void check_swing(const Modulator::State& before, const Modulator::State& now,
                   const Modulator::Output& out, const kernel::signal::Frame& frame,
                   double panel_ratio) {
    const double passed_s = before.started ? frame.time_s - before.time_s : 0.0;
    const double dt_s =
        std::isfinite(passed_s) ? std::clamp(passed_s, 0.0, config_.max_step_s) : 0.0;
    const double turn = dt_s / now.modulation.period_s;
    double moved = now.phase - before.phase;
    moved -= std::floor(moved + 1e-12);
    const double most = turn - std::floor(turn);
    if (!(now.phase >= 0.0 && now.phase < 1.0) ||
        (moved > 1e-9 && std::abs(moved - most) > 1e-9 && std::abs(moved - most) < 1.0 - 1e-9)) {
      fault(hunt.phase_jumps, "phase", moved - most);
    }
    if (!before.stepped || !now.stepped || out.ratio <= config_.min_ratio + 0.06 ||
        out.ratio * std::abs(frame.spindle_programmed_rev_s) <= config_.min_rev_s * (1.0 + 1e-9) ||
        out.ratio >= panel_ratio - 1e-9) {
      return;  // begins at the override in force; a limit holds at once
    }
    const double reach =
        dt_s * config_.acceleration_rev_s2 / std::abs(frame.spindle_programmed_rev_s) + 1e-9;
    const bool limited = out.ratio < before.ratio;  // a lower limit of the speed holds at once
    if (std::abs(out.ratio - before.ratio) > reach && !limited) {
      fault(hunt.speed_jumps, "ratio jumps", out.ratio - before.ratio);
    }
  }

  Hunt hunt;

 private:
  Modulator::Config config_;
};

}  // namespace steadyrest::chatter::online::test
