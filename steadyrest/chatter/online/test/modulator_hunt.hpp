// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/test/hunt_dice.hpp>
#include <steadyrest/chatter/online/test/hunt_sentences.hpp>
#include <steadyrest/chatter/online/test/hunted_override.hpp>

/// Random changes of everything that the modulator and its override can meet. One change per cycle.
namespace steadyrest::chatter::online::test {

/// One machine under random changes.
class Scene {
 public:
  using Frame = kernel::signal::Frame;

  explicit Scene(std::uint64_t seed)
      : dice_(seed),
        calm_(dice_.one_in(3)),
        setup_(random_setup(dice_, calm_)),
        walked_(dice_.one_in(2) && setup_.config.spindle_table.code.empty()),
        modulator_(Modulator::make(setup_.config).value()),
        spindle_(channel_config(setup_.config.spindle_table, setup_.config.min_ratio,
                                setup_.config.max_ratio),
                 walked_),
        feed_(channel_config(setup_.config.feed_table, setup_.config.min_feed_ratio,
                             setup_.config.max_feed_ratio),
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
      ++sentences_.hunt.changes;
    }
    return sentences_.hunt;
  }

 private:
  [[nodiscard]] kernel::override::Channel::Config channel_config(
      const kernel::machine::OverrideTable& table, double low, double high) const {
    return {.table = table,
            .min_ratio = low,
            .max_ratio = high,
            .fall_1_s = setup_.slew_1_s,
            .rise_1_s = setup_.slew_1_s,
            .latched = !walked_};
  }

  void change_modulation() {
    const Modulation before = modulator_.state().modulation;
    if (!modulator_.change(random_change(before, dice_)) &&
        modulator_.state().modulation.period_s != before.period_s) {
      sentences_.fault(sentences_.hunt.outside, "a refused change acted", before.period_s);
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
        frame_.spindle.panel_ratio = panel(setup_.config.spindle_table);
        frame_.spindle.panel_code_known = !dice_.one_in(10);
        break;
      case 4:
        frame_.feed.panel_ratio = panel(setup_.config.feed_table);
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

  /// For this cycle only.
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
    sentences_.check_request(out, frame, spindle_.table(), is_spoilt_);
    sentences_.check_swing(before, modulator_.state(), out, frame, frame_.spindle.panel_ratio);
    const bool hold = frame.motion == kernel::signal::Motion::thread ||
                      frame.motion == kernel::signal::Motion::tap;
    const auto unfit =
        is_spoilt_ ? kernel::outcome::Reason::input_stale : kernel::outcome::Reason::none;
    sentences_.check_word(spindle_.drive(frame_.time_s, out.spindle, frame_.spindle, unfit, hold));
    sentences_.check_word(feed_.drive(frame_.time_s, out.feed, frame_.feed, unfit, hold));
    is_spoilt_ = false;
  }

  void move_machine(double dt_s) {
    frame_.spindle.effective_ratio = spindle_.in_force(frame_.time_s);
    frame_.feed.effective_ratio = feed_.in_force(frame_.time_s);
    const double feed = frame_.feed.effective_ratio;
    const double goal = std::abs(frame_.spindle_programmed_rev_s) * frame_.spindle.effective_ratio;
    const double reach = setup_.config.acceleration_rev_s2 * dt_s;
    const double actual = std::abs(frame_.spindle_actual_rev_s);
    frame_.spindle_actual_rev_s = std::clamp(goal, actual - reach, actual + reach);
    if (calm_) {
      frame_.path_speed_mm_s = frame_.programmed_feed_mm_s * feed;
      const double per_tooth = feed * frame_.spindle_programmed_rev_s / frame_.spindle_actual_rev_s;
      if (per_tooth > setup_.config.max_feed_per_tooth_ratio * (1.0 + 1e-9)) {
        sentences_.fault(sentences_.hunt.feed_per_tooth, "feed per tooth in force above its band",
                         per_tooth / setup_.config.max_feed_per_tooth_ratio);
      }
      return;
    }
    if (!dice_.one_in(8)) {
      frame_.path_speed_mm_s = std::min(frame_.path_speed_mm_s, 20.0 * feed);
    }
  }

  Dice dice_;
  bool calm_;  ///< only the modulation changes, so its feed-per-tooth band is strict
  RandomSetup setup_;
  bool walked_;
  Modulator modulator_;
  Sentences sentences_{setup_.config};
  HuntedOverride spindle_;
  HuntedOverride feed_;
  Frame frame_;
  Frame spoilt_;
  bool is_spoilt_ = false;
};

/// Makes `changes` changes, with a new machine every 20 000.
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
