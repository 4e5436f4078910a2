// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <tests/opcua/control_side.hpp>

#include <steadyrest/adapters/opcua/control_text.hpp>

namespace steadyrest::opcua {
namespace {

using adapters::opcua::Answer;
using kernel::machine::Machine;
using kernel::signal::Motion;

constexpr double kPercent = 0.01;
constexpr double kPerMinute = 60.0;

/// Panel and PLC of the control show at once; what the network adds is the harness's.
Machine with_quick_panel(Machine machine) {
  for (auto* const table :
       {&machine.feed_override, &machine.rapid_override, &machine.spindle_override}) {
    table->dead_time_s = 0.0;
    table->scan_period_s = machine.control.interpolator_period_s;
  }
  return machine;
}

sim::MachineBody body_of(const ControlSide::Config& config) {
  auto body = sim::MachineBody::make({.machine = with_quick_panel(config.machine),
                                      .operator_actions = config.operator_actions})
                  .value();
  const auto& first = config.path->segments.front();
  kernel::signal::AxisValues at{};
  std::ranges::copy(first.start_mm, at.begin());
  body.reset(at);
  return body;
}

/// What PROG_EVENT.SPF does at power-up, before it calls the actions.
std::string power_up_of(const Machine& machine) {
  const std::string text = adapters::opcua::control_texts(machine).value()[1].text;
  const std::string begin = "IF $P_PROG_EVENT==4\n";
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find("ENDIF", from) - from);
}

double g_number(Motion motion) {
  return motion == Motion::rapid    ? 1.0
         : motion == Motion::thread ? 10.0
         : motion == Motion::tap    ? 11.0
                                    : 2.0;
}

}  // namespace

ControlSide::ControlSide(const Config& config)
    : machine_(config.machine),
      work_(config.machine.opcua.first_work),
      delay_s_(config.order_delay_s),
      program_(config.program),
      text_(adapters::opcua::control_texts(config.machine).value().front().text),
      power_up_(power_up_of(config.machine)),
      planned_(config.path),
      body_(body_of(config)),
      interpolator_(
          nc::plan::Interpolator::make(config.machine, nc::plan::whole(*planned_)).value()) {
  power_up_.start(*this);
  text_.start(*this);
  frame_ = body_.frame();
  step();
}

double& ControlSide::r(int number) {
  if (number < 0 || static_cast<std::size_t>(number) >= r_.size()) {
    throw std::runtime_error("no R" + std::to_string(number));
  }
  return r_[static_cast<std::size_t>(number)];
}

std::size_t ControlSide::axis_of(const std::string& name) const {
  for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
    const std::string& own = machine_.axes[i].name;
    if (name.ends_with("[" + own + "]") || name.ends_with("[" + own + "1]")) {
      return i;
    }
  }
  throw std::runtime_error("no axis in " + name);
}

double ControlSide::read(const std::string& name) {
  const std::string spindle = "[" + machine_.opcua.spindle + "]";
  if (name == "$AC_PLC_OVR") {
    return panel_ / kPercent;
  }
  if (name == "$AC_TOTAL_OVR") {
    return feed_in_force() / kPercent;
  }
  if (name == "$AA_PLC_OVR" + spindle) {
    return spindle_panel_ / kPercent;
  }
  if (name == "$AA_TOTAL_OVR" + spindle) {
    return spindle_panel_ * spindle_ovr_ / kPercent;
  }
  if (name == "$AC_VACTW") {
    return kPerMinute * frame_.path_speed_mm_s;
  }
  if (name == "$AC_PROG") {
    return finished() ? 0.0 : 2.0;
  }
  if (name == "$AC_SERUPRO") {
    return searches ? 1.0 : 0.0;
  }
  if (name.starts_with("$AA_IM[")) {
    return frame_.axis[axis_of(name)].command_mm;
  }
  if (name.starts_with("$VA_IM[")) {
    return frame_.axis[axis_of(name)].actual_mm;
  }
  throw std::runtime_error("the control has no " + name);
}

void ControlSide::write(const std::string& name, double value) {
  const std::string spindle = "[" + machine_.opcua.spindle + "]";
  if (name == "$AC_OVR" || name == "$AA_OVR" + spindle) {
    // As the manual has it: 0 … 200 %.
    const double ratio = std::clamp(kPercent * value, 0.0, 2.0);
    (name == "$AC_OVR" ? ovr_ : spindle_ovr_) = ratio;
  } else if (name.starts_with("$AA_OFF[")) {
    offset_[axis_of(name)] = value;
  } else {
    throw std::runtime_error("the control does not let " + name + " be written");
  }
}

void ControlSide::step() {
  while (!due_.empty() && due_.front().time_s <= frame_.time_s + 1e-9) {
    for (std::size_t i = 0; i < due_.front().values.size(); ++i) {
      r(due_.front().first + static_cast<int>(i)) = due_.front().values[i];
    }
    due_.pop_front();
  }
  // An override that is not written in this cycle counts as 100 %.
  ovr_ = 1.0;
  spindle_ovr_ = 1.0;
  text_.cycle(*this);
  const kernel::signal::Command offsets{.offset_mm = offset_, .write = true, .heartbeat = ++beats_};
  nc::plan::Overrides overrides = body_.begin(offsets);
  panel_ = overrides.feed_ratio;
  spindle_panel_ = body_.frame().spindle.panel_ratio;
  overrides.feed_ratio = panel_ * ovr_;
  body_.end(interpolator_.update(overrides));
  frame_ = body_.frame();
  frame_.path = planned_->segments;
}

bool ControlSide::range_of(const std::string& node, Range& out) {
  int channel = 0;
  int first = 0;
  int count = 0;
  char rest = 0;
  if (std::sscanf(node.c_str(), "s=/Channel/Parameter/R[u%d,%d,#%d]%c", &channel, &first, &count,
                  &rest) == 3 &&
      count > 0) {
    out = {.first = first, .count = static_cast<std::size_t>(count), .array = true};
    return true;
  }
  if (std::sscanf(node.c_str(), "s=/Channel/Parameter/R[u%d,%d]%c", &channel, &first, &rest) == 2) {
    out = {.first = first, .count = 1, .array = false};
    return true;
  }
  return false;
}

bool ControlSide::has(const std::string& node) const {
  Range range;
  return range_of(node, range) ||
         std::ranges::any_of(
             std::vector<std::string>{
                 "s=/Channel/State/cmdFeedRateIpo[u1]", "s=/Channel/Spindle/cmdSpeed[u1,1]",
                 "s=/Channel/Spindle/actSpeed[u1,1]", "s=/Plc/DB21.DBB208",
                 "s=/Channel/State/progStatus[u1]", "s=/Channel/ProgramInfo/actLineNumber[u1]",
                 "s=/Channel/ProgramInfo/progName[u1]"},
             [&](const std::string& own) { return own == node; });
}

Answer::Value ControlSide::show(const std::string& node) {
  Answer::Value out;
  Range range;
  if (range_of(node, range)) {
    for (std::size_t i = 0; i < range.count; ++i) {
      out.numbers.push_back(r(range.first + static_cast<int>(i)));
    }
  } else if (node == "s=/Channel/State/cmdFeedRateIpo[u1]") {
    out.numbers = {kPerMinute * frame_.programmed_feed_mm_s};
  } else if (node == "s=/Channel/Spindle/cmdSpeed[u1,1]") {
    out.numbers = {kPerMinute * frame_.spindle_programmed_rev_s * spindle_panel_ * spindle_ovr_};
  } else if (node == "s=/Channel/Spindle/actSpeed[u1,1]") {
    out.numbers = {kPerMinute * frame_.spindle_actual_rev_s};
  } else if (node == "s=/Plc/DB21.DBB208") {
    out.numbers = {g_number(frame_.motion)};
  } else if (node == "s=/Channel/State/progStatus[u1]") {
    out.numbers = {finished() ? 5.0 : 3.0};
  } else if (node == "s=/Channel/ProgramInfo/actLineNumber[u1]") {
    out.numbers = {static_cast<double>(frame_.program_line)};
  } else if (node == "s=/Channel/ProgramInfo/progName[u1]") {
    out.text = program_;
  } else {
    out.status = 0x80340000;  // BadNodeIdUnknown
  }
  return out;
}

void ControlSide::write(const std::string& node, const std::vector<double>& values) {
  Range range;
  if (range_of(node, range) && values.size() == range.count) {
    due_.push_back({.time_s = frame_.time_s + delay_s_, .first = range.first, .values = values});
  }
}

}  // namespace steadyrest::opcua
