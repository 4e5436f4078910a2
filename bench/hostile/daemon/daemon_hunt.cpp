// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <bench/hostile/daemon/daemon_hunt.hpp>
#include <bench/hostile/daemon/wild_port.hpp>
#include <bench/hostile/offset_watch.hpp>
#include <bench/hostile/override_watch.hpp>
#include <bench/hostile/variant.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tests/rig/even_pace.hpp>
#include <tests/rig/everything_on.hpp>

#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/protocol.hpp>

namespace steadyrest::bench::hostile {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using machine::Machine;
using machine::Mode;

constexpr double kLateSteps = 0.5;  ///< a stamp may be late by this much of a cycle

/// Time passes with the cycles alone.
/// Another machine of the same kind: other wires, rights, rates and rooms.
Machine varied(Machine m, Dice& dice) {
  for (auto* table : {&m.feed_override, &m.spindle_override}) {
    repeat_steps(*table, dice);
    table->layer_may_exceed_panel = dice.one_in(4);
    table->latched_word = table->coding != machine::Coding::gray || dice.one_in(2);
    table->scan_period_s = dice.of({0.0, 0.002, 0.01, 0.05});
  }
  m.envelope.feed_fall_1_s = dice.of({0.5, 2.0, 10.0, 100.0});
  m.envelope.feed_rise_1_s = dice.of({0.2, 1.0, 5.0});
  m.envelope.spindle_slew_1_s = dice.of({0.5, 2.0, 10.0});
  m.envelope.offset_slew_mm_s = dice.of({0.1, 0.05, 1.0});
  m.envelope.max_path_offset_mm = dice.of({0.0, 0.05, 0.2});
  m.envelope.path_offset_slew_mm_s = dice.of({5.0, 50.0});
  m.contour.enabled = !dice.one_in(5);
  m.contour.strategy =
      dice.of({machine::ContourStrategy::contour_priority, machine::ContourStrategy::feed_priority,
               machine::ContourStrategy::combined});
  m.chatter.enabled = !dice.one_in(3);
  m.chatter.law =
      dice.of({machine::SpeedLaw::constant, machine::SpeedLaw::square, machine::SpeedLaw::pulse,
               machine::SpeedLaw::triangle, machine::SpeedLaw::sine, machine::SpeedLaw::random});
  m.thermal.enabled = !dice.one_in(5);
  return m;
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

signal::AxisValues limits(const Machine& m, bool available, double max_mm) {
  signal::AxisValues out{};
  for (std::size_t i = 0; i < m.axes.size(); ++i) {
    out[i] = available && !m.axes[i].rotary ? max_mm : 0.0;
  }
  return out;
}

/// One start of the layer on one variant of the machine.
class DaemonScene {
 public:
  DaemonScene(const DaemonHunt& hunt, const Machine& base,
              std::shared_ptr<const nc::plan::PlannedPath> path, std::uint64_t seed);
  DaemonTally run();

 private:
  void begin_cycle();
  void judge(const signal::Command& command);
  void judge_override(const char* name, std::optional<OverrideWatch>& watch, bool masks,
                      std::uint32_t code, double ratio, double most_ratio);
  void judge_numbers(const signal::Command& command);
  void ask();
  void judge_end(const live::LoopFigures& figures);
  void broken(const std::string& what);
  [[nodiscard]] std::size_t allocations() const {
    return hunt_.allocations ? hunt_.allocations() : 0;
  }

  const DaemonHunt& hunt_;
  std::uint64_t seed_;
  Dice dice_;
  Machine machine_;
  std::unique_ptr<sim::SimulatedMachine> inner_;
  kernel::port::Capability can_;
  std::optional<WildPort> port_;
  std::optional<supervisor::Supervisor> layer_;
  std::optional<rig::EvenPace> pace_;
  std::optional<live::Loop> loop_;
  std::optional<OverrideWatch> feed_;
  std::optional<OverrideWatch> spindle_;
  std::optional<OffsetWatch> offset_;
  std::optional<OffsetWatch> path_offset_;
  double unheard_s_ = 0.0;
  bool may_write_ = false;
  bool wrote_ = false;
  std::uint64_t cycle_ = 0;
  std::uint64_t heartbeat_ = 0;
  std::size_t judge_allocated_ = 0;
  signal::Command last_;
  DaemonTally tally_;
};

DaemonScene::DaemonScene(const DaemonHunt& hunt, const Machine& base,
                         std::shared_ptr<const nc::plan::PlannedPath> path, std::uint64_t seed)
    : hunt_(hunt), seed_(seed), dice_(seed), machine_(varied(base, dice_)) {
  inner_ = rig::chattering(machine_, std::move(path));
  can_ = inner_->capability();
  can_.feed_override = can_.feed_override && !dice_.one_in(10);
  can_.spindle_override = can_.spindle_override && !dice_.one_in(10);
  can_.axis_offset = can_.axis_offset && !dice_.one_in(10);
  can_.path_offset = can_.path_offset && !dice_.one_in(10);
  port_.emplace(*inner_, can_, machine_, dice_);
  layer_.emplace(rig::listening(machine_, can_));
  const double period_s = layer_cycle_s(machine_);
  pace_.emplace(period_s);
  loop_.emplace(*port_, *layer_, *pace_,
                live::Loop::Config{.period_s = period_s,
                                   .contour_limit_mm = machine_.contour.limit_mm,
                                   .handback_s = 20.0,
                                   .mode = dice_.of({Mode::observe, Mode::advise, Mode::act}),
                                   .most_cycles = hunt.scene,
                                   .port_paces = dice_.one_in(3)});
  const auto& e = machine_.envelope;
  const double slack_s = kLateSteps * period_s;
  feed_.emplace(rules(machine_.feed_override, can_.latched_word, can_.feed_override,
                      e.feed_fall_1_s, e.feed_rise_1_s, slack_s));
  spindle_.emplace(rules(machine_.spindle_override, can_.latched_word, can_.spindle_override,
                         e.spindle_slew_1_s, e.spindle_slew_1_s, slack_s));
  offset_.emplace(OffsetWatch::Rules{limits(machine_, can_.axis_offset, e.max_offset_mm),
                                     e.offset_slew_mm_s, slack_s});
  path_offset_.emplace(OffsetWatch::Rules{limits(machine_, can_.path_offset, e.max_path_offset_mm),
                                          e.path_offset_slew_mm_s, slack_s, true});
  may_write_ = loop_->mode_wanted() == Mode::act;
  port_->before_read = [this] { begin_cycle(); };
  port_->taken = [this](const signal::Command& command) { judge(command); };
}

void DaemonScene::broken(const std::string& what) {
  if (!what.empty() && tally_.broken == 0) {
    ++tally_.broken;
    tally_.first = fmt::format("{}, seed {}, cycle {}: {}", machine_.name, seed_, cycle_, what);
  }
}

/// Real time passes on the machine's side; modes and questions come from other threads.
void DaemonScene::begin_cycle() {
  const std::size_t before = allocations();
  const double period_s = layer_cycle_s(machine_);
  ++cycle_;
  unheard_s_ += period_s;
  const bool dropped = unheard_s_ > machine::holds_s(machine_);
  for (auto* watch : {&*feed_, &*spindle_}) {
    watch->pass(period_s);
    if (dropped) {
      watch->drop();
    }
  }
  for (auto* watch : {&*offset_, &*path_offset_}) {
    watch->pass(period_s);
    if (dropped) {
      watch->drop();
    }
  }
  if (!wrote_ && loop_->mode_wanted() != Mode::act && layer_->mode_in_force() != Mode::act) {
    may_write_ = false;
  }
  wrote_ = false;
  // Good input at the end, so that the hand-over can be judged.
  if (cycle_ + 400 > hunt_.scene) {
    port_->behave();
  }
  if (dice_.one_in(300)) {
    loop_->ask_mode(dice_.of({Mode::observe, Mode::advise, Mode::act, Mode::act, Mode::act}));
  }
  may_write_ = may_write_ || loop_->mode_wanted() == Mode::act;
  if (dice_.one_in(5000)) {
    ask();
  }
  judge_allocated_ += allocations() - before;
}

/// What a client sees is JSON whatever the machine showed.
void DaemonScene::ask() {
  ++tally_.asked;
  const std::string answer =
      live::answer({.loop = *loop_, .port = "hostile"}, R"({"version":1,"ask":"status"})");
  if (!nlohmann::json::accept(answer)) {
    broken("status: no JSON: " + answer);
  }
}

void DaemonScene::judge_override(const char* name, std::optional<OverrideWatch>& watch, bool masks,
                                 std::uint32_t code, double ratio, double most_ratio) {
  const bool was_masked = watch->masked();
  const double before = watch->in_force();
  broken(watch->write({.code = code, .masks = masks}, false));
  if (!masks) {
    return;
  }
  if (!(std::abs(watch->in_force() - ratio) <= kTolerance)) {
    broken(fmt::format("{}: states {:g}, the word is {:g}", name, ratio, watch->in_force()));
  }
  if (!(ratio <= most_ratio + kTolerance)) {
    broken(fmt::format("{}: {:g} above the envelope's {:g}", name, ratio, most_ratio));
  }
  tally_.moved += was_masked && watch->in_force() != before ? 1 : 0;
}

void DaemonScene::judge_numbers(const signal::Command& command) {
  bool finite = std::isfinite(command.feed_ratio) && std::isfinite(command.spindle_ratio);
  for (std::size_t i = 0; i < command.offset_mm.size(); ++i) {
    finite =
        finite && std::isfinite(command.offset_mm[i]) && std::isfinite(command.path_offset_mm[i]);
  }
  if (!finite) {
    broken("a number is not finite");
  }
  for (const auto reason : {command.feed_reason, command.spindle_reason, command.offset_reason,
                            command.path_offset_reason}) {
    if (kernel::outcome::name(reason) == "unknown") {
      broken(fmt::format("reason {} has no name", static_cast<int>(reason)));
    }
  }
  if (!command.write || !may_write_) {
    broken("mode: written without act");
  }
  if (command.heartbeat <= heartbeat_) {
    broken("heartbeat: does not rise");
  }
  heartbeat_ = command.heartbeat;
}

void DaemonScene::judge(const signal::Command& command) {
  const std::size_t before = allocations();
  unheard_s_ = 0.0;
  wrote_ = true;
  ++tally_.written;
  tally_.masked += command.feed_masks_panel || command.spindle_masks_panel ? 1 : 0;
  tally_.moved += command.offset_mm != last_.offset_mm ? 1 : 0;
  if (port_->shown().any) {
    feed_->panel(port_->shown().feed_ratio);
    spindle_->panel(port_->shown().spindle_ratio);
  }
  judge_numbers(command);
  judge_override("feed", feed_, command.feed_masks_panel, command.feed_code, command.feed_ratio,
                 machine_.envelope.max_feed_ratio);
  judge_override("spindle", spindle_, command.spindle_masks_panel, command.spindle_code,
                 command.spindle_ratio, machine_.envelope.max_spindle_ratio);
  broken(offset_->write(command.offset_mm, true, false));
  broken(path_offset_->write(command.path_offset_mm, true, false));
  last_ = command;
  judge_allocated_ += allocations() - before;
}

void DaemonScene::judge_end(const live::LoopFigures& figures) {
  if (figures.cycles < hunt_.scene) {
    broken(fmt::format("the loop ended after {} cycles", figures.cycles));
  }
  if (!figures.handed_back) {
    broken("not handed back after good input");
  }
  // Less what the watchdog has dropped.
  if (feed_->masked() || spindle_->masked() || !offset_->at_zero() || !path_offset_->at_zero()) {
    broken("something of the layer is left at the end");
  }
}

DaemonTally DaemonScene::run() {
  const std::size_t before = allocations();
  const live::LoopFigures& figures = loop_->run();
  tally_.allocated = allocations() - before - judge_allocated_;
  tally_.cycles = figures.cycles;
  tally_.failed = figures.port_faults;
  judge_end(figures);
  return tally_;
}

}  // namespace

void DaemonTally::add(const DaemonTally& other) {
  cycles += other.cycles;
  written += other.written;
  masked += other.masked;
  moved += other.moved;
  failed += other.failed;
  asked += other.asked;
  allocated += other.allocated;
  broken += other.broken;
  first = first.empty() ? other.first : first;
}

DaemonTally hunt(const DaemonHunt& hunt) {
  const Machine base = rig::everything_on(hunt.machine);
  const auto path = rig::busy_path(base, 20);
  DaemonTally all;
  for (std::uint64_t seed = hunt.seed; all.cycles < hunt.cycles; ++seed) {
    all.add(DaemonScene(hunt, base, path, seed).run());
  }
  return all;
}

}  // namespace steadyrest::bench::hostile
