// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/test/hunt_dice.hpp>
#include <steadyrest/chatter/online/test/hunted_override.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>

/// Random changes of everything that the modulator and the override behind it can meet, and the
/// sentences on safety that must hold in each cycle. One change, one cycle.
namespace steadyrest::chatter::online::test {

struct Hunt {
  std::uint64_t changes = 0;
  std::uint64_t wishes = 0;   ///< cycles in which the spindle was asked for something
  std::uint64_t words = 0;    ///< changes of a masked word
  std::uint64_t outside = 0;  ///< a request outside of the limits, or not neutral unasked
  std::uint64_t phase_jumps = 0;
  std::uint64_t speed_jumps = 0;     ///< the swing moved faster than the drive
  std::uint64_t feed_per_tooth = 0;  ///< asked, or in force at the machine, above the band
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

/// One machine under random changes.
class Scene {
 public:
  using Frame = kernel::signal::Frame;

  explicit Scene(std::uint64_t seed)
      : dice_(seed),
        calm_(dice_.one_in(3)),
        config_(random_config()),
        walked_(dice_.one_in(2) && config_.spindle_table.code.empty()),
        modulator_(Modulator::make(config_).value()),
        spindle_(channel_config(config_.spindle_table, config_.min_ratio, config_.max_ratio),
                 walked_),
        feed_(channel_config(config_.feed_table, config_.min_feed_ratio, config_.max_feed_ratio),
              walked_) {
    frame_.motion = kernel::signal::Motion::feed;
    frame_.speed_modulation = true;
    frame_.programmed_feed_mm_s = 20.0;
    frame_.spindle_programmed_rev_s = 50.0;
    frame_.spindle_actual_rev_s = 50.0;
  }

  Hunt play(std::uint64_t changes) {
    for (std::uint64_t i = 0; i < changes; ++i) {
      change();
      cycle();
      ++hunt_.changes;
    }
    return hunt_;
  }

 private:
  Modulator::Config random_config() {
    namespace tables = kernel::override::test;
    Modulator::Config c;
    c.spindle_table = dice_.one_in(4) ? tables::percent_word() : tables::spindle_840d();
    c.feed_table = dice_.one_in(2) ? tables::feed_840d() : tables::feed_dmg();
    c.spindle_table.layer_may_exceed_panel = dice_.one_in(3);
    c.feed_table.layer_may_exceed_panel = dice_.one_in(3);
    for (auto* table : {&c.spindle_table, &c.feed_table}) {
      table->scan_period_s = dice_.within(0.001, 0.03);
      table->dead_time_s = dice_.one_in(2) ? 0.0 : dice_.within(0.0, 0.1);
    }
    c.min_ratio = dice_.within(0.3, 0.8);
    c.max_ratio = std::max(c.min_ratio + dice_.within(0.21, 0.6), 0.7);
    c.max_rev_s = dice_.one_in(2) ? kernel::machine::kUnlimited : dice_.within(40.0, 80.0);
    c.min_rev_s = dice_.one_in(2) ? 0.0 : dice_.within(0.0, 30.0);
    slew_1_s_ = dice_.within(0.2, 20.0);
    c.acceleration_rev_s2 = dice_.within(1.0, 400.0);
    c.min_feed_per_tooth_ratio = dice_.within(0.5, 1.0);
    c.max_feed_per_tooth_ratio = dice_.within(1.0, 1.5);
    c.fade_s = dice_.within(0.01, 1.0);
    c.hysteresis = dice_.within(0.0, 0.5);
    c.always = dice_.one_in(4);
    if (calm_) {  // nothing but the modulation moves the feed per tooth
      c.max_ratio = std::max(c.max_ratio, 1.0);
      c.max_rev_s = std::max(c.max_rev_s, 50.0);
    }
    return c;
  }
  [[nodiscard]] kernel::override::Channel::Config channel_config(
      const kernel::machine::OverrideTable& table, double low, double high) const {
    return {.table = table,
            .min_ratio = low,
            .max_ratio = high,
            .fall_1_s = slew_1_s_,
            .rise_1_s = slew_1_s_,
            .latched = !walked_};
  }

  void change_modulation() {
    Modulation m = modulator_.state().modulation;
    switch (dice_.below(6)) {
      case 0:
        m.law = static_cast<Law>(dice_.below(7));
        break;
      case 1:
        m.amplitude_ratio = dice_.one_in(16) ? dice_.unfit() : dice_.within(0.0, 0.9);
        break;
      case 2:
        m.amplitude_rev_s = dice_.one_in(16)  ? dice_.unfit()
                            : dice_.one_in(2) ? 0.0
                                              : dice_.within(0.0, 30.0);
        break;
      case 3:
        m.period_s = dice_.one_in(16) ? dice_.unfit() : std::exp(dice_.within(-3.9, 6.3));
        break;
      case 4:
        m.mean_ratio = dice_.one_in(16) ? dice_.unfit() : dice_.within(0.1, 2.0);
        break;
      default:
        m.law = dice_.one_in(8) ? static_cast<Law>(dice_.below(256)) : m.law;
        m.seed = dice_.next();
    }
    const Modulation before = modulator_.state().modulation;
    if (!modulator_.change(m) && modulator_.state().modulation.period_s != before.period_s) {
      fault(hunt_.outside, "a refused change acted", before.period_s);
    }
  }

  double panel(const kernel::machine::OverrideTable& table) {
    return dice_.one_in(12) ? 0.0 : table.ratio[dice_.below(table.ratio.size())];
  }

  void change() {
    using kernel::signal::Motion;
    switch (calm_ ? 16 : dice_.below(16)) {
      case 0:
        frame_.motion = dice_.one_in(2) ? Motion::feed : static_cast<Motion>(dice_.below(9));
        break;
      case 1:
        frame_.speed_modulation = !dice_.one_in(4);
        break;
      case 2:
        frame_.spindle_programmed_rev_s = dice_.one_in(8) ? 0.0 : dice_.within(-80.0, 80.0);
        break;
      case 3:
        frame_.spindle.panel_ratio = panel(config_.spindle_table);
        frame_.spindle.panel_code_known = !dice_.one_in(10);
        break;
      case 4:
        frame_.feed.panel_ratio = panel(config_.feed_table);
        frame_.feed.panel_code_known = !dice_.one_in(10);
        break;
      case 5:
        frame_.feed_per_revolution = dice_.one_in(4);
        break;
      case 6:
        frame_.path_speed_mm_s = dice_.within(0.0, 30.0);
        break;
      case 7:
        spoil();
        break;
      default:
        change_modulation();
    }
  }

  /// For this cycle alone.
  void spoil() {
    spoilt_ = frame_;
    is_spoilt_ = true;
    switch (dice_.below(6)) {
      case 0:
        spoilt_.spindle_actual_rev_s = dice_.unfit();
        break;
      case 1:
        spoilt_.age_s = dice_.one_in(2) ? dice_.unfit() : 1.0;
        break;
      case 2:
        spoilt_.time_s = dice_.one_in(2) ? dice_.unfit() : frame_.time_s - 1.0;
        break;
      case 3:
        spoilt_.feed.effective_ratio = dice_.unfit();
        break;
      case 4:
        spoilt_.spindle.panel_ratio = dice_.unfit();
        break;
      default:
        spoilt_.programmed_feed_mm_s = dice_.unfit();
    }
  }

  void fault(std::uint64_t& counter, const char* what, double seen) {
    ++counter;
    if (hunt_.first.empty()) {
      hunt_.first = fmt::format("change {}: {}: {:.17g}", hunt_.changes, what, seen);
    }
  }

  void cycle() {
    const double dt_s = dice_.one_in(50) ? dice_.within(0.0, 2.0) : dice_.within(0.0, 0.02);
    frame_.time_s += dt_s;
    move_machine(dt_s);
    if (is_spoilt_ && std::isfinite(spoilt_.time_s) && spoilt_.time_s > frame_.time_s - 0.5) {
      spoilt_.time_s = frame_.time_s;
    }
    const Frame& frame = is_spoilt_ ? spoilt_ : frame_;
    const Modulator::State before = modulator_.state();
    const kernel::signal::InForce told{
        .feed = feed_.told(), .spindle = spindle_.told(), .written = true};
    const Modulator::Output out = modulator_.update(frame, told);
    check_request(out, frame);
    check_swing(before, out, frame);
    const bool hold = frame.motion == kernel::signal::Motion::thread ||
                      frame.motion == kernel::signal::Motion::tap;
    const auto unfit =
        is_spoilt_ ? kernel::outcome::Reason::input_stale : kernel::outcome::Reason::none;
    check_word(spindle_.drive(frame_.time_s, out.spindle, frame_.spindle, unfit, hold));
    check_word(feed_.drive(frame_.time_s, out.feed, frame_.feed, unfit, hold));
    is_spoilt_ = false;
  }

  void move_machine(double dt_s) {
    frame_.spindle.effective_ratio = spindle_.in_force(frame_.time_s);
    frame_.feed.effective_ratio = feed_.in_force(frame_.time_s);
    const double feed = frame_.feed.effective_ratio;
    const double goal = std::abs(frame_.spindle_programmed_rev_s) * frame_.spindle.effective_ratio;
    const double reach = config_.acceleration_rev_s2 * dt_s;
    const double actual = std::abs(frame_.spindle_actual_rev_s);
    frame_.spindle_actual_rev_s = std::clamp(goal, actual - reach, actual + reach);
    if (calm_) {
      frame_.path_speed_mm_s = frame_.programmed_feed_mm_s * feed;
      const double per_tooth = feed * frame_.spindle_programmed_rev_s / frame_.spindle_actual_rev_s;
      if (per_tooth > config_.max_feed_per_tooth_ratio * (1.0 + 1e-9)) {
        fault(hunt_.feed_per_tooth, "feed per tooth in force above its band",
              per_tooth / config_.max_feed_per_tooth_ratio);
      }
      return;
    }
    if (!dice_.one_in(8)) {
      frame_.path_speed_mm_s = std::min(frame_.path_speed_mm_s, 20.0 * feed);
    }
  }

  void check_word(const HuntedOverride::Seen& seen) {
    if (seen.invalid) {
      fault(hunt_.invalid_codes, "invalid code", seen.code);
    }
    if (seen.outside) {
      fault(hunt_.words_outside, "a word decodes outside of [from, to]", *seen.outside);
    }
    hunt_.words += seen.changed ? 1U : 0U;
  }

  void check_request(const Modulator::Output& out, const Frame& frame) {
    constexpr double kTolerance = 1e-9;
    const auto& table = spindle_.table();
    for (const auto& [ratio, reason] : {std::pair{out.spindle.ratio, out.spindle.reason},
                                        std::pair{out.feed.ratio, out.feed.reason}}) {
      if (!std::isfinite(ratio) || (!kernel::override::is_wish(reason) && ratio != 1.0)) {
        fault(hunt_.outside, "not neutral", ratio);
      }
    }
    if (out.active && is_spoilt_ && !std::isfinite(frame.time_s)) {
      fault(hunt_.outside, "active on unfit input", frame.time_s);
    }
    if (kernel::override::is_wish(out.spindle.reason)) {
      ++hunt_.wishes;
      const double ratio = out.spindle.ratio;
      const auto step = table.nearest_step(ratio);
      if (!step || table.ratio(*step) != ratio) {
        fault(hunt_.outside, "no step of the table", ratio);
      }
      if (ratio < config_.min_ratio - kTolerance || ratio > config_.max_ratio + kTolerance) {
        fault(hunt_.outside, "spindle outside of its limits", ratio);
      }
      const double speed = ratio * std::abs(frame.spindle_programmed_rev_s);
      const bool lowest = ratio <= table.ratio(*table.ceil_step(config_.min_ratio)) + kTolerance;
      if (speed > config_.max_rev_s * (1.0 + kTolerance) && !lowest) {
        fault(hunt_.outside, "faster than the spindle can", speed);
      }
      if (!config_.spindle_table.layer_may_exceed_panel && !lowest &&
          ratio > frame.spindle.panel_ratio + kTolerance) {
        fault(hunt_.outside, "above the panel", ratio);
      }
    }
    if (kernel::override::is_wish(out.feed.reason)) {
      const double ratio = out.feed.ratio;
      if (ratio < config_.min_feed_ratio - kTolerance ||
          ratio > config_.max_feed_ratio + kTolerance) {
        fault(hunt_.outside, "feed outside of its limits", ratio);
      }
      const double shown = std::abs(frame.spindle_actual_rev_s / frame.spindle_programmed_rev_s);
      const double actual = std::max(shown, table.ratio(*table.ceil_step(config_.min_ratio)));
      if (shown > 1e-3 && ratio > config_.max_feed_per_tooth_ratio * actual + 1e-6) {
        fault(hunt_.feed_per_tooth, "feed per tooth above its band", ratio / actual);
      }
    }
  }

  void check_swing(const Modulator::State& before, const Modulator::Output& out,
                   const Frame& frame) {
    const Modulator::State& now = modulator_.state();
    const double passed_s = before.started ? frame.time_s - before.time_s : 0.0;
    const double dt_s =
        std::isfinite(passed_s) ? std::clamp(passed_s, 0.0, config_.max_step_s) : 0.0;
    const double turn = dt_s / now.modulation.period_s;
    double moved = now.phase - before.phase;
    moved -= std::floor(moved + 1e-12);
    const double most = turn - std::floor(turn);
    if (!(now.phase >= 0.0 && now.phase < 1.0) ||
        (moved > 1e-9 && std::abs(moved - most) > 1e-9 && std::abs(moved - most) < 1.0 - 1e-9)) {
      fault(hunt_.phase_jumps, "phase", moved - most);
    }
    if (!before.stepped || !now.stepped || out.ratio <= config_.min_ratio + 0.06 ||
        out.ratio * std::abs(frame.spindle_programmed_rev_s) <= config_.min_rev_s * (1.0 + 1e-9) ||
        out.ratio >= frame_.spindle.panel_ratio - 1e-9) {
      return;  // begins at the override in force; a limit holds at once
    }
    const double reach =
        dt_s * config_.acceleration_rev_s2 / std::abs(frame.spindle_programmed_rev_s) + 1e-9;
    const bool limited = out.ratio < before.ratio;  // a lower limit of the speed holds at once
    if (std::abs(out.ratio - before.ratio) > reach && !limited) {
      fault(hunt_.speed_jumps, "ratio jumps", out.ratio - before.ratio);
    }
  }

  Dice dice_;
  double slew_1_s_ = 2.0;  ///< of both envelopes
  bool calm_;  ///< only the modulation changes, so that its band of the feed per tooth is strict
  Modulator::Config config_;
  bool walked_;
  Modulator modulator_;
  HuntedOverride spindle_;
  HuntedOverride feed_;
  Frame frame_;
  Frame spoilt_;
  bool is_spoilt_ = false;
  Hunt hunt_;
};

/// `changes` of them, a new machine every 20 000.
inline Hunt hunt(std::uint64_t seed, std::uint64_t changes) {
  constexpr std::uint64_t kOfOneMachine = 20'000;
  Hunt all;
  while (all.changes < changes) {
    Scene scene(seed++);
    all.add(scene.play(std::min(kOfOneMachine, changes - all.changes)));
  }
  return all;
}

}  // namespace steadyrest::chatter::online::test
