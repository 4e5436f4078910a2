// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/channel.hpp>
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
  std::uint64_t speed_jumps = 0;     ///< the swing moved faster than slew and drive
  std::uint64_t feed_per_tooth = 0;  ///< asked to pass the band upwards
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

/// splitmix64
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  std::uint64_t below(std::uint64_t n) { return (next() >> 11U) % n; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1.0p-53;
  }
  double unfit() {
    constexpr std::array kUnfit{std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), -1.0, 1e300};
    return kUnfit[below(kUnfit.size())];
  }

 private:
  std::uint64_t state_;
};

/// One machine under random changes.
class Scene {
 public:
  using Channel = kernel::override::Channel;
  using Frame = kernel::signal::Frame;

  explicit Scene(std::uint64_t seed)
      : dice_(seed),
        config_(random_config()),
        walked_(dice_.one_in(2) && config_.spindle_table.code.empty()),
        modulator_(Modulator::make(config_).value()),
        spindle_(Channel::make(
                     channel_config(config_.spindle_table, config_.min_ratio, config_.max_ratio))
                     .value()),
        feed_(Channel::make(channel_config(config_.feed_table, config_.min_feed_ratio,
                                           config_.max_feed_ratio))
                  .value()) {
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
  struct Word {
    std::uint32_t code = 0;
    bool masks = false;
    bool known = false;
  };

  Modulator::Config random_config() {
    namespace tables = kernel::override::test;
    Modulator::Config c;
    c.spindle_table = dice_.one_in(4) ? tables::percent_word() : tables::spindle_840d();
    c.feed_table = dice_.one_in(2) ? tables::feed_840d() : tables::feed_dmg();
    c.spindle_table.layer_may_exceed_panel = dice_.one_in(3);
    c.feed_table.layer_may_exceed_panel = dice_.one_in(3);
    c.spindle_table.scan_period_s = dice_.within(0.001, 0.03);
    c.min_ratio = dice_.within(0.3, 0.8);
    c.max_ratio = std::max(c.min_ratio + dice_.within(0.21, 0.6), 0.7);
    c.max_rev_s = dice_.one_in(2) ? kernel::machine::kUnlimited : dice_.within(40.0, 80.0);
    c.min_rev_s = dice_.one_in(2) ? 0.0 : dice_.within(0.0, 30.0);
    c.slew_1_s = dice_.within(0.2, 20.0);
    c.acceleration_rev_s2 = dice_.within(1.0, 400.0);
    c.min_feed_per_tooth_ratio = dice_.within(0.5, 1.0);
    c.max_feed_per_tooth_ratio = dice_.within(1.0, 1.5);
    c.fade_s = dice_.within(0.01, 1.0);
    c.hysteresis = dice_.within(0.0, 0.5);
    c.always = dice_.one_in(4);
    return c;
  }
  [[nodiscard]] Channel::Config channel_config(const kernel::machine::OverrideTable& table,
                                               double low, double high) const {
    return {.table = table,
            .min_ratio = low,
            .max_ratio = high,
            .fall_1_s = config_.slew_1_s,
            .rise_1_s = config_.slew_1_s,
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
    switch (dice_.below(16)) {
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
    const Modulator::Output out = modulator_.update(frame);
    check_request(out, frame);
    check_swing(before, out, frame);
    const bool hold = frame.motion == kernel::signal::Motion::thread ||
                      frame.motion == kernel::signal::Motion::tap;
    const auto unfit =
        is_spoilt_ ? kernel::outcome::Reason::input_stale : kernel::outcome::Reason::none;
    spindle_ratio_ =
        drive(spindle_, spindle_word_, spindle_ratio_, out.spindle, frame_.spindle, unfit, hold);
    feed_ratio_ = drive(feed_, feed_word_, feed_ratio_, out.feed, frame_.feed, unfit, hold);
    is_spoilt_ = false;
  }

  void move_machine(double dt_s) {
    const double goal = std::abs(frame_.spindle_programmed_rev_s) * spindle_ratio_;
    const double reach = config_.acceleration_rev_s2 * dt_s;
    const double actual = std::abs(frame_.spindle_actual_rev_s);
    frame_.spindle_actual_rev_s = std::clamp(goal, actual - reach, actual + reach);
    frame_.spindle.effective_ratio = spindle_ratio_;
    frame_.feed.effective_ratio = feed_ratio_;
    if (!dice_.one_in(8)) {
      frame_.path_speed_mm_s = std::min(frame_.path_speed_mm_s, 20.0 * feed_ratio_);
    }
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
    const double reach = dt_s * config_.slew_1_s + 1e-9;
    const bool limited = out.ratio < before.ratio;  // a lower limit of the speed holds at once
    if (std::abs(out.ratio - before.ratio) > reach && !limited) {
      fault(hunt_.speed_jumps, "ratio jumps", out.ratio - before.ratio);
    }
  }

  /// Through envelope and hand-over; gives the ratio in force.
  template <class Request>
  double drive(Channel& channel, Word& word, double before, const Request& request,
               const kernel::signal::OverrideState& panel, kernel::outcome::Reason unfit,
               bool hold) {
    const auto out = channel.update({.time_s = frame_.time_s,
                                     .ratio = hold ? 1.0 : request.ratio,
                                     .reason = request.reason,
                                     .panel = panel,
                                     .unfit = unfit,
                                     .hold = hold});
    const auto& table = channel.table();
    const auto step = table.step_of_code(out.code);
    if (!step) {
      fault(hunt_.invalid_codes, "invalid code", out.code);
      return before;
    }
    const bool exceeds = table.layer_may_exceed_panel();
    const auto in_force = [&](double ratio, bool masks) {
      const bool counts = masks && panel.panel_ratio > 0.0;
      return !counts ? panel.panel_ratio : exceeds ? ratio : std::min(ratio, panel.panel_ratio);
    };
    const double now = in_force(table.ratio(*step), out.masks_panel);
    if (word.known && walked_ && panel.panel_code_known) {
      const auto from_step = table.step_of_code(word.code);
      const double from = in_force(from_step ? table.ratio(*from_step) : 0.0, word.masks);
      const auto [low, high] = std::minmax(from, now);
      const std::uint32_t differing = word.code ^ out.code;
      for (std::uint32_t part = differing;; part = (part - 1) & differing) {
        const auto seen = table.step_of_code(word.code ^ part);
        for (const bool masks : {word.masks, out.masks_panel}) {
          const double ratio = seen    ? in_force(table.ratio(*seen), masks)
                               : masks ? -1.0
                                       : panel.panel_ratio;
          if (ratio < low - 1e-9 || ratio > high + 1e-9) {
            fault(hunt_.words_outside, "a word decodes outside of [from, to]", ratio);
          }
        }
        if (part == 0) {
          break;
        }
      }
    }
    hunt_.words += word.masks && out.masks_panel && word.code != out.code ? 1U : 0U;
    word = {.code = out.code, .masks = out.masks_panel, .known = true};
    return now;
  }

  Dice dice_;
  Modulator::Config config_;
  bool walked_;
  Modulator modulator_;
  Channel spindle_;
  Channel feed_;
  Frame frame_;
  Frame spoilt_;
  bool is_spoilt_ = false;
  Word spindle_word_;
  Word feed_word_;
  double spindle_ratio_ = 1.0;
  double feed_ratio_ = 1.0;
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
