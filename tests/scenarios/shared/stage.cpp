// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/rig/even_pace.hpp>
#include <tests/rig/everything_on.hpp>
#include <tests/scenarios/shared/stage.hpp>

#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;

std::unexpected<kernel::outcome::Refusal> failure() {
  return std::unexpected(kernel::outcome::Refusal{.kind = kernel::outcome::Kind::unavailable,
                                                  .file = {},
                                                  .what = "the link is lost",
                                                  .to_do = "look at the cable"});
}

}  // namespace

/// Between the loop and the simulated machine.
class Stage::Port final : public kernel::port::Port {
 public:
  explicit Port(Stage& stage) : stage_(stage) {}
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return stage_.inner_->capability();
  }
  Result<Frame> read() noexcept override {
    stage_.begin_cycle();
    const std::size_t cycle = stage_.log_.size() - 1;
    link_ = stage_.link ? stage_.link(cycle) : Link::good;
    auto frame = stage_.inner_->read();
    if (!frame || link_ == Link::no_read) {
      return failure();
    }
    if (stage_.show) {
      stage_.show(cycle, *frame);
    }
    Cycle& seen = stage_.log_.back();
    seen.read = true;
    seen.frame = *frame;
    seen.frame.path = {};
    seen.frame.vibration = {};
    if (frame->feed.panel_code_known && frame->feed.panel_ratio >= 0.0) {
      stage_.feed_->panel(frame->feed.panel_ratio);
    }
    return frame;
  }
  Result<void> write(const Command& command) noexcept override {
    if (link_ == Link::no_write) {
      return failure();
    }
    stage_.judge(command);
    stage_.log_.back().written = command;
    return link_ == Link::ignored ? Result<void>{} : stage_.inner_->write(command);
  }

 private:
  Stage& stage_;
  Link link_ = Link::good;
};

Stage::Stage(const Config& config) : machine_(rig::everything_on("vmc-840d")), mode_(config.mode) {
  machine_.chatter.enabled = false;
  machine_.envelope.max_path_offset_mm = config.max_path_offset_mm;
  nc::interpret::Config dialect;
  dialect.dialect = machine_.control.dialect;
  dialect.axes = "XYZ";
  const auto path = std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(config.program, dialect, machine_, "scenario.mpf").value());
  inner_ = sim::SimulatedMachine::make(
               {.machine = machine_, .path = path, .operator_actions = config.operator_actions})
               .value();
  const auto& e = machine_.envelope;
  const double slack_s = 0.5 * machine_.control.interpolator_period_s;
  feed_ = std::make_unique<bench::hostile::OverrideWatch>(
      bench::hostile::OverrideWatch::Rules{.table = machine_.feed_override,
                                           .fall_1_s = e.feed_fall_1_s,
                                           .rise_1_s = e.feed_rise_1_s,
                                           .slack_s = slack_s});
  kernel::signal::AxisValues most{};
  std::fill_n(most.begin(), machine_.axes.size(), e.max_offset_mm);
  offset_ = std::make_unique<bench::hostile::OffsetWatch>(
      bench::hostile::OffsetWatch::Rules{most, e.offset_slew_mm_s, slack_s});
  std::fill_n(most.begin(), machine_.axes.size(), e.max_path_offset_mm);
  path_offset_ = std::make_unique<bench::hostile::OffsetWatch>(
      bench::hostile::OffsetWatch::Rules{most, e.path_offset_slew_mm_s, slack_s, true});
}

void Stage::begin_cycle() {
  if (!log_.empty()) {
    log_.back().status = loop_->status();
  }
  log_.emplace_back();
  if (wish) {
    wish(log_.size() - 1, *loop_);
  }
  const double period_s = machine_.control.interpolator_period_s;
  unheard_s_ += period_s;
  feed_->pass(period_s);
  offset_->pass(period_s);
  path_offset_->pass(period_s);
  if (unheard_s_ > machine_.envelope.stale_after_s) {
    feed_->drop();
    offset_->drop();
    path_offset_->drop();
  }
}

void Stage::broken(const std::string& what) {
  if (!what.empty() && broken_.empty()) {
    broken_ = fmt::format("cycle {}: {}", log_.size() - 1, what);
  }
}

void Stage::judge(const Command& command) {
  unheard_s_ = 0.0;
  broken(command.write ? "" : "written without act");
  broken(feed_->write({.code = command.feed_code, .masks = command.feed_masks_panel}, false));
  broken(std::isfinite(command.feed_ratio) ? "" : "the feed ratio is not finite");
  broken(offset_->write(command.offset_mm, true, false));
  broken(path_offset_->write(command.path_offset_mm, true, false));
}

void Stage::run(std::size_t cycles) {
  Port port(*this);
  auto layer = supervisor::Supervisor::make(machine_, port.capability()).value();
  const double period_s = machine_.control.interpolator_period_s;
  rig::EvenPace pace(period_s);
  live::Loop loop(port, layer, pace,
                  {.period_s = period_s,
                   .contour_limit_mm = machine_.contour.limit_mm,
                   .handback_s = 20.0,
                   .mode = mode_,
                   .most_cycles = cycles});
  loop_ = &loop;
  figures_ = loop.run();
  log_.back().status = loop.status();
  loop_ = nullptr;
  EXPECT_EQ(broken_, "");
  EXPECT_GE(figures_.cycles, cycles) << "the loop ended early";
}

std::uint32_t Stage::feed_code(double ratio) const {
  const auto table = kernel::override::Table::make(machine_.feed_override).value();
  return table.code(table.nearest_step(ratio).value());
}

double Stage::largest_rise(std::size_t from, std::size_t to) const {
  double rise = 0.0;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < std::min(to, log_.size()); ++i) {
    rise = std::max(rise, log_[i].feed_ratio() - log_[i - 1].feed_ratio());
  }
  return rise;
}

std::size_t Stage::named(kernel::outcome::Reason reason, std::size_t from, std::size_t to) const {
  std::size_t count = 0;
  for (std::size_t i = from; i < std::min(to, log_.size()); ++i) {
    count += log_[i].status.reasons[0] == reason ? 1 : 0;
  }
  return count;
}

void stand(Frame& frame, const Frame& since) {
  for (std::size_t i = 0; i < frame.axis.size(); ++i) {
    frame.axis[i].command_mm = since.axis[i].command_mm;
    frame.axis[i].actual_mm = since.axis[i].command_mm;
    frame.axis[i].following_error_mm = 0.0;
  }
  frame.path_position_mm = since.path_position_mm;
  frame.path_index = since.path_index;
  frame.path_speed_mm_s = 0.0;
  frame.motion = kernel::signal::Motion::idle;
}

}  // namespace steadyrest::scenarios
