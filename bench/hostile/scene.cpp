// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <bench/hostile/scene.hpp>
#include <bench/hostile/variant.hpp>
#include <fmt/format.h>

#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::bench::hostile {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::outcome::Reason;
using kernel::units::kInfinity;
using kernel::units::kNan;
using machine::Mode;
using signal::Motion;

/// A stamp may be late by half a cycle, so real time and stamped time differ by that.
constexpr double kLateSteps = 0.5;  // a stamp may be late by this much of a cycle
/// The layer holds an offset through short standstills between two blocks; the watch must too.
constexpr double kShortIdle_s = 0.5;

bool thread(Motion motion) {
  return motion == Motion::thread || motion == Motion::tap;
}

OverrideWatch::Rules rules(const machine::OverrideTable& table, bool latched, bool available,
                           double fall_1_s, double rise_1_s, double slack_s) {
  return {.table = table,
          .latched = latched && table.latched_word,
          .available = available,
          .fall_1_s = fall_1_s,
          .rise_1_s = rise_1_s,
          .slack_s = slack_s};
}

}  // namespace

/// The rules that apply depend on the port's abilities; a supervisor that refuses the combination
/// is right, and the scene takes one that works.
Scene::Scene(const machine::Machine& of, std::uint64_t seed)
    : dice_(seed), seed_(seed), machine_(of) {
  vary(machine_, dice_);
  can_ = {.feed_override = !dice_.one_in(10),
          .spindle_override = !dice_.one_in(10),
          .axis_offset = !dice_.one_in(10),
          .path_offset = !dice_.one_in(10),
          .latched_word = dice_.one_in(2)};
  auto made = supervisor::Supervisor::make(machine_, can_);
  if (!made) {  // a table that cannot be walked needs a port that latches
    can_.latched_word = true;
    machine_.feed_override.latched_word = machine_.spindle_override.latched_word = true;
    made = supervisor::Supervisor::make(machine_, can_);
  }
  if (!made) {  // no step of the varied table is within the envelope
    machine_.feed_override = of.feed_override;
    machine_.spindle_override = of.spindle_override;
    made = supervisor::Supervisor::make(machine_, can_);
  }
  layer_.emplace(std::move(made.value()));
  cycle_s_ = layer_cycle_s(machine_);
  watchdog_s_ = machine::holds_s(machine_);
  const double slack_s = kLateSteps * cycle_s_;
  const auto& e = machine_.envelope;
  if (!machine_.feed_override.ratio.empty()) {
    feed_.emplace(rules(machine_.feed_override, can_.latched_word, can_.feed_override,
                        e.feed_fall_1_s, e.feed_rise_1_s, slack_s));
  }
  if (!machine_.spindle_override.ratio.empty()) {
    spindle_.emplace(rules(machine_.spindle_override, can_.latched_word, can_.spindle_override,
                           e.spindle_slew_1_s, e.spindle_slew_1_s, slack_s));
  }
  offset_.emplace(
      OffsetWatch::Rules{limits(can_.axis_offset, e.max_offset_mm), e.offset_slew_mm_s, slack_s});
  path_offset_.emplace(OffsetWatch::Rules{limits(can_.path_offset, e.max_path_offset_mm),
                                          e.path_offset_slew_mm_s, slack_s, true});
  port_.emplace(machine_, can_, cycle_s_, dice_);
  wanted_ = machine_.mode;
  may_write_ = wanted_ == Mode::act;
}

signal::AxisValues Scene::limits(bool available, double max_mm) const {
  signal::AxisValues out{};
  for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
    out[i] = available && !machine_.axes[i].rotary ? max_mm : 0.0;
  }
  return out;
}

void Scene::other_limits() {
  vary_limits(machine_, dice_);
  offset_->limit(limits(can_.axis_offset, machine_.envelope.max_offset_mm));
  path_offset_->limit(limits(can_.path_offset, machine_.envelope.max_path_offset_mm));
}

void Scene::broken(const std::string& what) {
  if (!what.empty() && ++tally_.broken == 1) {
    tally_.first = fmt::format("{}, seed {}, cycle {} (t = {:g} s): {}", machine_.name, seed_,
                               tally_.cycles, port_->frame.time_s, what);
  }
}

/// Wishes of all kinds: valid, impossible, several at once from different rooms.
void Scene::wish() {
  const auto reason = [this] {
    return dice_.of({Reason::contour_limit, Reason::contour_limit, Reason::chatter_modulating,
                     Reason::none, Reason::not_cutting, Reason::input_stale});
  };
  const auto ratio = [this] {
    return dice_.one_in(8) ? dice_.of({kNan, kInfinity, -kInfinity, -1.0, 1e300, 0.0, 9.9})
                           : dice_.within(0.0, 1.4);
  };
  feed_wish_.clear();
  spindle_wish_.clear();
  for (std::size_t n = dice_.below(3); n > 0; --n) {
    feed_wish_.push_back({signal::Room::contour, ratio(), reason()});
  }
  for (std::size_t n = dice_.below(3); n > 0; --n) {
    spindle_wish_.push_back(
        {dice_.of({signal::Room::chatter, signal::Room::motion}), ratio(), reason()});
  }
  for (auto* wishes : {&offset_wish_, &path_offset_wish_}) {
    wishes->clear();
    for (std::size_t n = dice_.below(3); n > 0; --n) {
      signal::OffsetRequest wished{.reason = reason()};
      for (double& mm : wished.offset_mm) {
        mm = dice_.one_in(20) ? dice_.of({kNan, kInfinity, 1e9}) : dice_.within(-0.3, 0.3);
      }
      wishes->push_back(wished);
    }
  }
}

/// Real time passes on the machine's side, whatever the layer's clock says. After the watchdog's
/// time nothing of the layer remains in force.
void Scene::let_pass(double real_s) {
  port_->pass(real_s);
  unheard_s_ += real_s;
  for (auto* watch : {&feed_, &spindle_}) {
    if (*watch) {
      (*watch)->pass(real_s);
    }
  }
  offset_->pass(real_s);
  path_offset_->pass(real_s);
  if (unheard_s_ > watchdog_s_) {
    for (auto* watch : {&feed_, &spindle_}) {
      if (*watch) {
        (*watch)->drop();
      }
    }
    offset_->drop();
    path_offset_->drop();
    unsure_ = true;
  }
}

/// A changed machine file takes over between two cycles.
void Scene::reload() {
  const machine::Machine before = machine_;
  other_limits();
  auto old = std::move(*layer_);
  layer_.emplace(supervisor::Supervisor::make(machine_, can_).value());
  layer_->take_over(old, supervisor::kept(before, machine_));
}

/// A new process takes over the state of the old one, perhaps with another machine file; the
/// machine may have waited for minutes.
void Scene::restart(double away_s) {
  const supervisor::Supervisor::State state = layer_->state();
  if (dice_.one_in(2)) {
    other_limits();
  }
  layer_.emplace(supervisor::Supervisor::make(machine_, can_).value());
  layer_->restore(state);
  if (away_s > 0.0) {
    let_pass(away_s);
  }
  ++tally_.interrupted;
}

/// What the layer certainly knows. Two consecutive clean frames show the motion; a single one may
/// be believed or not, so rules that depend on the motion are not checked then.
void Scene::know() {
  const Motion motion = port_->frame.motion;
  if (port_->clean && was_clean_ && motion == last_) {
    shown_ = motion;
    unsure_ = false;
    idle_s_ = motion == Motion::idle ? idle_s_ + cycle_s_ : 0.0;
    const bool cuts = motion == Motion::feed || thread(motion);
    cut_ = cuts || (cut_ && motion != Motion::rapid && motion != Motion::tool_change &&
                    idle_s_ < kShortIdle_s);
  } else if (motion == Motion::rapid || motion == Motion::tool_change) {
    cut_ = false;  // the layer may or may not believe it
  } else if (motion == Motion::idle) {
    idle_s_ += cycle_s_;
    cut_ = cut_ && idle_s_ < kShortIdle_s;
  }
  // The layer may believe a frame that shows something else, unless it is certainly unfit: then it
  // must keep its knowledge.
  if (!thread(motion) && !port_->unfit && thread(shown_)) {
    unsure_ = true;
  }
  was_clean_ = port_->clean;
  last_ = motion;
}

bool Scene::in_thread() const {
  return !unsure_ && (thread(port_->frame.motion) || thread(shown_));
}

/// Each command that arrived is judged by the three watches.
void Scene::check_write() {
  const signal::Command& c = port_->last;
  unheard_s_ = 0.0;
  ++tally_.written;
  tally_.masked += c.feed_masks_panel || c.spindle_masks_panel ? 1 : 0;
  tally_.held += in_thread() && (c.feed_masks_panel || c.spindle_masks_panel) ? 1 : 0;
  if (feed_) {
    const bool was = feed_->masked();
    const double before = feed_->in_force();
    broken(feed_->write({c.feed_code, c.feed_masks_panel}, in_thread()));
    tally_.moved += was && feed_->in_force() != before ? 1 : 0;
  } else if (c.feed_masks_panel) {
    broken("capability: a feed override that the machine does not have");
  }
  if (spindle_) {
    broken(spindle_->write({c.spindle_code, c.spindle_masks_panel}, in_thread()));
  } else if (c.spindle_masks_panel) {
    broken("capability: a spindle override that the machine does not have");
  }
  // An offset may move in the cut only while requested with valid input in mode act.
  const bool asks = !offset_wish_.empty() || machine_.thermal.enabled;
  const bool heard = !port_->unfit && wanted_ == Mode::act;
  const signal::AxisValues heat_mm = offset_->held_mm();
  const signal::AxisValues path_mm = path_offset_->held_mm();
  broken(offset_->write(c.offset_mm, asks && heard, cut_));
  broken(path_offset_->write(c.path_offset_mm, !path_offset_wish_.empty() && heard, cut_));
  // Both together within the path's limit, unless heat alone is beyond it or a limit was lowered.
  for (std::size_t i = 0; i < heat_mm.size(); ++i) {
    const double most_mm =
        std::max({path_offset_->limit_mm(i), std::abs(c.offset_mm[i]),
                  std::abs(c.path_offset_mm[i]), std::abs(heat_mm[i] + path_mm[i])});
    if (!(std::abs(c.offset_mm[i] + c.path_offset_mm[i]) <= most_mm + kTolerance)) {
      broken(
          fmt::format("sum: axis {} at {:g} and {:g} mm", i, c.offset_mm[i], c.path_offset_mm[i]));
    }
  }
}

/// observe and advise write nothing, but returning to neutral does: until that is done, a write
/// without act is right.
void Scene::check_mode(bool has_command, const signal::Command& command) {
  if (port_->taken && !may_write_) {
    broken("mode: written without act");
  }
  if (has_command && command.heartbeat != heartbeat_ + 1) {
    broken("heartbeat: not one more");
  }
  heartbeat_ = has_command ? command.heartbeat : layer_->state().heartbeat;
  const bool nothing_left = (!feed_ || !feed_->masked()) && (!spindle_ || !spindle_->masked()) &&
                            offset_->at_zero() && path_offset_->at_zero();
  if (has_command && !command.write && wanted_ != Mode::act && nothing_left &&
      layer_->mode_in_force() != Mode::act) {
    may_write_ = false;
  }
}

/// Order as in the design: time passes, the layer cycles, the frame becomes known, the write is
/// judged.
void Scene::cycle() {
  let_pass(cycle_s_);
  const auto command = layer_->cycle(*port_, {.feed = feed_wish_,
                                              .spindle = spindle_wish_,
                                              .offset = offset_wish_,
                                              .path_offset = path_offset_wish_});
  ++tally_.cycles;
  if (!command && port_->reads_fail) {
    unsure_ = unsure_ || !thread(shown_);
  } else {
    know();
  }
  if (feed_ && port_->any_shown) {
    feed_->panel(port_->shown_feed);
  }
  if (spindle_ && port_->any_shown) {
    spindle_->panel(port_->shown_spindle);
  }
  if (port_->taken) {
    check_write();
  }
  check_mode(command.has_value(), command ? *command : signal::Command{});
  port_->outage -= port_->outage > 0 ? 1 : 0;
}

/// Between two cycles: another mode, a restart with and without a long absence, a lost link, a
/// process that was held up for less than the watchdog's time.
void Scene::events() {
  if (dice_.one_in(400)) {
    wanted_ = dice_.of({Mode::observe, Mode::advise, Mode::act, Mode::act});
    layer_->set_mode(wanted_);
    may_write_ = may_write_ || wanted_ == Mode::act;
  }
  if (dice_.one_in(2000)) {
    reload();
  }
  if (dice_.one_in(2000) && port_->keeps_time()) {
    restart(0.0);
  }
  if (dice_.one_in(4000) && port_->keeps_time_well()) {
    restart(2.0 * watchdog_s_ + dice_.within(0.0, 60.0));
  }
  if (dice_.one_in(500)) {
    let_pass(dice_.within(0.0, 0.5) * std::max(0.0, watchdog_s_ - unheard_s_));
  }
  if (dice_.one_in(2000) && port_->keeps_time_well() && port_->outage == 0) {
    const double for_s = watchdog_s_ * (dice_.one_in(2) ? 0.4 : dice_.within(2.0, 5.0));
    port_->outage = static_cast<std::uint32_t>(std::ceil(for_s / cycle_s_));
    port_->reads_fail = dice_.one_in(2);
    ++tally_.interrupted;
  }
}

void Scene::act() {
  port_->begin_act();
  wish();
  const std::size_t cycles = 1 + dice_.below(400);
  for (std::size_t i = 0; i < cycles && tally_.broken == 0; ++i) {
    if (dice_.one_in(100)) {
      wish();
    }
    // Not at the edges of an act, so that the scene knows its start and end.
    if (i > 20 && i + 5 < cycles && port_->outage == 0) {
      events();
    }
    cycle();
  }
  while (port_->outage > 0 && tally_.broken == 0) {
    cycle();
  }
  for (int i = 0; i < 5 && tally_.broken == 0; ++i) {
    cycle();  // what ended is known before the next act begins
  }
}

Tally Scene::run(int acts) {
  for (int i = 0; i < acts && tally_.broken == 0; ++i) {
    act();
    if (dice_.one_in(60)) {
      settle_on_a_wish();
    }
    if (dice_.one_in(60)) {
      settle_on_observe();
    }
  }
  return tally_;
}

}  // namespace steadyrest::bench::hostile
