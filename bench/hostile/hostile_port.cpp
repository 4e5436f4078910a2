// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <bench/hostile/hostile_port.hpp>

#include <steadyrest/kernel/units/constants.hpp>

// Faults are drawn once per act and then strike one frame in so many: in practice a control fails
// in one way for a while, and that finds more than single wild frames.
namespace steadyrest::bench::hostile {
namespace {

namespace signal = kernel::signal;
using kernel::units::kInfinity;
using kernel::units::kNan;
using signal::Motion;

kernel::outcome::Result<void> link_lost() {
  return std::unexpected(kernel::outcome::Refusal{
      .kind = kernel::outcome::Kind::unavailable, .file = {}, .what = {}, .to_do = {}});
}

}  // namespace

HostilePort::HostilePort(const kernel::machine::Machine& machine,
                         const kernel::port::Capability& capability, double cycle_s, Dice& dice)
    : machine_(machine), can_(capability), cycle_s_(cycle_s), dice_(dice) {
  frame.axis_count = static_cast<std::uint8_t>(machine.axes.size());
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto& axis = machine.axes[i];
    const double middle = axis.rotary ? 0.0 : 0.5 * (axis.min_au + axis.max_au);
    frame.axis[i].command_mm = frame.axis[i].actual_mm = middle;
  }
  const auto nearest_to_1 = [](const kernel::machine::OverrideTable& table) {
    double nearest = table.ratio.empty() ? 1.0 : std::min(table.ratio.front(), table.max_ratio);
    for (const double ratio : table.ratio) {
      const double here = std::min(ratio, table.max_ratio);
      nearest = std::abs(here - 1.0) < std::abs(nearest - 1.0) ? here : nearest;
    }
    return nearest;
  };
  feed_panel_ = shown_feed = nearest_to_1(machine.feed_override);
  spindle_panel_ = shown_spindle = nearest_to_1(machine.spindle_override);
  // The control's clock need not start at 0, and it may start below.
  real_s_ = dice.of({0.0, 1.0, 1000.0, 1e6, -50.0});
}

void HostilePort::begin_act() {
  frame.motion = static_cast<Motion>(dice_.below(9));
  // A third of the acts cut, whatever the other draw says; most rules apply only there.
  if (dice_.one_in(3)) {
    frame.motion = Motion::feed;
  }
  frame.programmed_feed_mm_s = dice_.of({0.0, 20.0, 100.0});
  frame.path_speed_mm_s = frame.programmed_feed_mm_s * dice_.share();
  frame.spindle_programmed_rev_s = dice_.of({0.0, 20.0, -30.0});
  frame.spindle_actual_rev_s = frame.spindle_programmed_rev_s;
  frame.speed_modulation = dice_.one_in(3);
  glitch_ = dice_.of<std::uint64_t>({0, 0, 0, 200, 20, 5, 2});
  fault_ = dice_.of<std::uint64_t>({0, 0, 0, 100, 10, 2});
  turns_ = dice_.of<std::uint64_t>({0, 0, 300, 60, 3});
  // One fault may last for the whole act.
  lasting_ = dice_.one_in(6) ? 1 + static_cast<int>(dice_.below(7)) : 0;
  if (dice_.one_in(8)) {  // the control's clock is set, or begins again
    offset_s_ = dice_.of({-real_s_, -real_s_ - 7.0, 3600.0, -0.05, 0.3, 1e6});
    set_ = true;
  }
}

void HostilePort::behave(Motion motion) {
  glitch_ = fault_ = turns_ = 0;
  lasting_ = 0;
  stands_ = 0;
  outage = 0;
  frame.motion = motion;
}

/// Wrong stamps: not finite, off by a millisecond to a fortnight in either direction, off by less
/// than a second, absurd, or frozen for some cycles.
double HostilePort::stamp() noexcept {
  const double truth_s = real_s_ + offset_s_;
  if (stands_ > 0) {
    --stands_;
    return last_stamp_s_;
  }
  if (glitch_ == 0 || !dice_.one_in(glitch_)) {
    return truth_s;
  }
  switch (dice_.below(7)) {
    case 0:
      return dice_.of({kNan, kInfinity, -kInfinity});
    case 1:
      return truth_s - std::pow(10.0, dice_.within(-3.0, 6.0));
    case 2:
      return truth_s + std::pow(10.0, dice_.within(-3.0, 6.0));
    case 3:
      return truth_s - dice_.within(0.0, 1.0);
    case 4:
      return truth_s + dice_.within(0.0, 1.0);
    case 5:
      return dice_.of({0.0, -1e300, 1e300});
    default:
      stands_ = static_cast<std::uint32_t>(dice_.below(40));
      return last_stamp_s_;
  }
}

/// The panel: mostly on a step, sometimes between two, sometimes 0, which must stop whatever the
/// layer wants.
void HostilePort::turn(signal::OverrideState& state, double& truth,
                       const kernel::machine::OverrideTable& table) noexcept {
  if (table.ratio.empty()) {
    return;
  }
  if (turns_ > 0 && dice_.one_in(turns_)) {
    switch (dice_.below(5)) {
      case 0:
        truth = 0.0;
        break;
      case 1:
        truth = dice_.within(std::min(table.ratio.front(), table.max_ratio),
                             std::min(table.ratio.back(), table.max_ratio));
        break;
      default:
        truth = std::min(table.ratio[dice_.below(table.ratio.size())], table.max_ratio);
    }
  }
  state.panel_ratio = truth;
  state.panel_code_known = true;
  state.effective_ratio = truth;
}

/// One fault of a frame: stale, not finite, more axes than there are, or a panel that shows nothing
/// sensible. The last two must not stop the rooms, only the panel's own channel.
void HostilePort::spoil() noexcept {
  const int fault = lasting_ > 0 ? lasting_ - 1 : static_cast<int>(dice_.below(7));
  clean = false;
  unfit = fault != 4 && fault != 5;  // a bad panel is its own channel's affair
  switch (fault) {
    case 0:
      frame.age_s = dice_.of({1.0, kNan, kInfinity, -5.0});
      break;
    case 1:
      frame.axis[0].following_error_mm = dice_.of({kNan, kInfinity});
      break;
    case 2:
      frame.axis_count = 200;
      break;
    case 3:
      frame.axis[0].actual_mm = dice_.of({-kInfinity, kNan});
      break;
    case 4:
      frame.feed.panel_code_known = frame.spindle.panel_code_known = false;
      break;
    case 5:
      frame.feed.panel_ratio = frame.spindle.panel_ratio = dice_.of({kNan, -1.0, 1e300});
      break;
    default:
      frame.path_speed_mm_s = dice_.of({kNan, -kInfinity});
  }
}

kernel::outcome::Result<signal::Frame> HostilePort::read() noexcept {
  taken = false;
  clean = unfit = false;
  if (outage > 0 && reads_fail) {
    return std::unexpected(link_lost().error());
  }
  frame.time_s = stamp();
  // `clean` is what the scene may rely on: a true stamp, no fault, no clock just set.
  const double late_s = std::abs(frame.time_s - (real_s_ + offset_s_));
  true_stamp_ = late_s == 0.0;
  clean = true_stamp_ && !set_;
  set_ = false;
  last_stamp_s_ = std::isfinite(frame.time_s) ? frame.time_s : last_stamp_s_;
  frame.age_s = 0.0;
  frame.axis_count = static_cast<std::uint8_t>(machine_.axes.size());
  frame.axis[0].following_error_mm = 0.0;
  frame.axis[0].actual_mm = frame.axis[0].command_mm;
  frame.path_speed_mm_s = std::isfinite(frame.path_speed_mm_s) ? frame.path_speed_mm_s : 0.0;
  turn(frame.feed, feed_panel_, machine_.feed_override);
  turn(frame.spindle, spindle_panel_, machine_.spindle_override);
  if (lasting_ > 0 || (fault_ > 0 && dice_.one_in(fault_))) {
    spoil();
  }
  // The panel as last seen by the layer; the watch compares with that, not with a truth never
  // shown.
  const auto show = [this](const signal::OverrideState& state, double& shown) {
    if (state.panel_code_known && std::isfinite(state.panel_ratio) && state.panel_ratio >= 0.0 &&
        state.panel_ratio <= 10.0) {
      shown = state.panel_ratio;
      any_shown = true;
    }
  };
  show(frame.feed, shown_feed);
  show(frame.spindle, shown_spindle);
  return frame;
}

/// A link that fails on writes still shows frames; the layer must notice by the answer.
kernel::outcome::Result<void> HostilePort::write(const signal::Command& command) noexcept {
  if (outage > 0 && !reads_fail) {
    return link_lost();
  }
  last = command;
  taken = true;
  return {};
}

}  // namespace steadyrest::bench::hostile
