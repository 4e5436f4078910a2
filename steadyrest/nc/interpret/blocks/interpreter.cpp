// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/decode/codes.hpp>

namespace steadyrest::nc::interpret {

using read::Block;
using read::Word;

kernel::outcome::Result<Interpreter> Interpreter::make(Config config) {
  const auto refuse = [](std::string what, std::string to_do) {
    return std::unexpected(kernel::outcome::Refusal{.kind = kernel::outcome::Kind::bad_input,
                                                    .file = {},
                                                    .line = 0,
                                                    .what = std::move(what),
                                                    .to_do = std::move(to_do)});
  };
  for (const char letter : config.axes) {
    if (kAxisLetters.find(letter) == std::string_view::npos) {
      return refuse("axis letters `" + config.axes + "`", "name axes out of XYZABCUVW");
    }
  }
  if (config.active_offset >= kWorkOffsets) {
    return refuse("active work offset " + std::to_string(config.active_offset + 1),
                  "choose 1 (G54) to 9 (G59.3)");
  }
  for (const std::int32_t code : {config.modulation_on, config.modulation_off}) {
    if (code < 0 || (code != 0 && group_of_m(code).known)) {
      return refuse("M" + std::to_string(code) + " for the speed modulation",
                    "choose an M word that has no meaning yet, as 38 and 39");
    }
  }
  const auto finite = [](const Axes& axes) {
    return std::ranges::all_of(axes, [](double value) { return std::isfinite(value); });
  };
  if (!finite(config.start) || !finite(config.g92) || !finite(config.external) ||
      !finite(config.tool_offset) || !std::ranges::all_of(config.work_offset, finite) ||
      !std::ranges::all_of(config.home, finite)) {
    return refuse("an offset or start position that is not finite", "give finite numbers");
  }
  return Interpreter(std::move(config));
}

Interpreter::Interpreter(Config config)
    : config_(std::move(config)), rules_(&rules_of(config_.dialect)) {
  for (const char letter : config_.axes) {
    axes_allowed_ |= Step::bit(letter);
  }
  state_.work_offset = config_.work_offset;
  state_.rotation_deg = config_.rotation_deg;
  state_.active_offset = config_.active_offset;
  state_.work_in_force = state_.work_offset[state_.active_offset];
  state_.external = config_.external;
  state_.g92 = config_.g92_on ? config_.g92 : Axes{};
  state_.g92_stored = config_.g92;
  state_.g92_on = config_.g92_on;
  state_.tool_offset = config_.tool_offset;
  state_.home = config_.home;
  state_.unit_mm = config_.inch ? kMmPerInch : 1.0;
  state_.feed_unit_mm = state_.unit_mm;
  state_.tool_in_spindle = config_.tool_in_spindle;
  state_.selected_tool = config_.tool_in_spindle;
  state_.retract_to_initial = rules_->starts_with_g98;
  state_.position = config_.start;
  update_offset();
  state_.position = to_work(config_.start);
  parameters_->keep(config_.numbers);
}

bool Interpreter::execute(const Block& block, Sink& sink) {
  program_call_.kind = ProgramCall::Kind::none;
  const bool filled = std::exchange(plain_before_, false);
  if (block.deleted() && config_.block_delete) {
    return true;
  }
  if (block.end_mark()) {
    finished_ = true;
    cutter_->bind(sink);
    cutter_->on_event(
        {.kind = EventKind::end, .line = block.line(), .value = 0.0, .tool_name = {}});
    return true;
  }
  if (block.words().empty()) {
    return true;
  }
  cutter_->bind(sink);
  sink_ = state_.cutter_side != 0 ? static_cast<Sink*>(cutter_.get()) : &sink;
  if (block.words().front().qualifier == read::Qualifier::fine) {
    return set_fine(block.words().front());
  }
  if (!decode(block)) {
    return false;
  }
  if (is_plain(step_)) {
    return execute_plain(step_, filled);
  }
  if (step_.frame != 0) {
    return set_frame(step_);
  }
  if (!(check(step_) && frame_settles(step_) && act(step_))) {
    return false;
  }
  return !modal_cycle_ || motion_now_ < 0 || (step_.mask & kAxisMask) == 0 ||
         drill_call(*modal_cycle_);
}

bool Interpreter::survey(const Block& block) {
  if (!block.words().empty() && block.words().front().qualifier == read::Qualifier::fine) {
    return true;
  }
  return decode(block);
}

bool Interpreter::decode(const Block& block) {
  step_.reset(block);
  const bool accepted = rules_->decode(
      {.config = config_, .state = state_, .axes = axes_allowed_, .refusals = refusals_}, block,
      step_);
  if (step_.motion_mode != kNoCode) {
    state_.motion = step_.motion_mode;
  }
  return accepted;
}

bool Interpreter::act(const Step& step) {
  move_.line = step.line;
  if (step.modulation >= 0) {
    state_.speed_modulation = step.modulation == 1;
  }
  move_.speed_modulation = state_.speed_modulation;
  if (rules_->units_first) {
    set_units(step);
  }
  return set_feed(step) && set_spindle_speed(step) && select_tool(step) && change_tool(step) &&
         keep_modes(step) && set_spindle(step) && (set_coolant(step), true) && set_override(step) &&
         set_io(step) && set_modes(step) && non_modal(step) && move(step) && call_program(step) &&
         stop(step);
}

// mm/min, mm/rev or 1/min to the inner unit. On LinuxCNC an F word acts in the units that were in
// force before the block: it comes before G20/G21 in the order of execution.
bool Interpreter::set_feed(const Step& step) {
  const int mode = step.code(GGroup::feed_mode);
  if (mode != kNoCode) {
    const FeedMode wanted = mode == g::kInverseTime ? FeedMode::inverse_time
                            : mode == g::kPerMinute ? FeedMode::per_minute
                                                    : FeedMode::per_revolution;
    if (wanted != state_.feed_mode || rules_->feed_mode_clears_feed) {
      state_.feed_mode = wanted;
      state_.feed_mm_s = 0.0;
      state_.feed_deg_s = 0.0;
    }
  }
  if (!step.has('F')) {
    return true;
  }
  const double unit = state_.feed_unit_mm;
  switch (state_.feed_mode) {
    case FeedMode::per_minute:
      state_.feed_mm_s = step['F'] * unit / 60.0;
      state_.feed_deg_s = step['F'] / 60.0;
      break;
    case FeedMode::inverse_time:
      state_.feed_mm_s = step['F'] / 60.0;
      state_.feed_deg_s = state_.feed_mm_s;
      break;
    case FeedMode::per_revolution:
      state_.feed_mm_s = step['F'] * unit;
      state_.feed_deg_s = step['F'];
      break;
  }
  return true;
}

bool Interpreter::set_spindle_speed(const Step& step) {
  const int mode = step.code(GGroup::spindle_mode);
  if (mode == g::kCuttingSpeed) {
    if (!step.has('S')) {
      return refuse_code(step, 'G', 96, "speed_missing", "G96 without its cutting speed (S)");
    }
    state_.surface_speed = true;
    state_.spindle_limit_rev_s = step.has('D') ? std::abs(step['D']) / 60.0 : 0.0;
  } else if (mode == g::kSpindleSpeed) {
    state_.surface_speed = false;
    state_.surface_speed_mm_s = 0.0;
    state_.spindle_limit_rev_s = 0.0;
  }
  if (!step.has('S')) {
    return true;
  }
  if (state_.surface_speed) {  // m/min, after G20 ft/min
    constexpr double kMmPerFoot = 304.8;
    const bool inch = state_.unit_mm != 1.0;
    state_.surface_speed_mm_s = step['S'] * (inch ? kMmPerFoot : 1000.0) / 60.0;
    state_.spindle_speed_rev_s = 0.0;
  } else {
    state_.spindle_speed_rev_s = step['S'] / 60.0;
  }
  if (state_.spindle_direction != 0) {
    emit_spindle();
  }
  return true;
}

const Tool* Interpreter::find_tool(std::int32_t number) const noexcept {
  static constexpr Tool kNoTool{};
  if (number == 0 || !config_.tools) {
    if (config_.tools) {
      const auto found = std::ranges::find(*config_.tools, 0, &Tool::number);
      return found == config_.tools->end() ? &kNoTool : &*found;
    }
    return &kNoTool;
  }
  const auto found = std::ranges::find(*config_.tools, number, &Tool::number);
  return found == config_.tools->end() ? nullptr : &*found;
}

bool Interpreter::tool_number(const Step& step, char letter, std::int32_t& number) {
  number = static_cast<std::int32_t>(step[letter]);
  return find_tool(number) != nullptr ||
         refuse(step, letter, "no_such_tool", "a tool that is not in the tool table");
}

bool Interpreter::select_tool(const Step& step) {
  if (!step.tool_name.empty()) {
    selected_name_ = step.tool_name;
    state_.selected_tool = 0;
    return true;
  }
  if (step.has('T')) {
    selected_name_.clear();
  }
  return !step.has('T') || tool_number(step, 'T', state_.selected_tool);
}

bool Interpreter::change_tool(const Step& step) {
  const int code = step.code(MGroup::tool_change);
  if (code == kNoCode) {
    return true;
  }
  if (code == m::kToolInSpindle) {
    if (!step.has('Q') || step['Q'] != std::floor(step['Q']) || step['Q'] < 0.0) {
      return refuse_code(step, 'M', 61, "tool_missing",
                         "M61 without the number of the tool in the spindle (Q)");
    }
    read_position_anew();
    if (!tool_number(step, 'Q', state_.tool_in_spindle)) {
      return false;
    }
    load_tool();
    return true;
  }
  state_.spindle_direction = 0;
  emit_spindle();
  state_.tool_in_spindle = state_.selected_tool;
  load_tool();
  read_position_anew();
  sink_->on_event({.kind = EventKind::tool_change,
                   .line = step.line,
                   .value = static_cast<double>(state_.tool_in_spindle),
                   .tool_name = selected_name_});
  return true;
}

// #5401 … show the tool of the last change; rs274 leaves them as they are at T0 M6.
void Interpreter::load_tool() {
  if (const Tool* const tool = place_of_tool(state_.tool_in_spindle); tool != nullptr) {
    state_.tool = *tool;
  }
}

bool Interpreter::set_spindle(const Step& step) {
  const int code = step.code(MGroup::spindle);
  if (code != kNoCode) {
    state_.spindle_direction = code == m::kClockwise ? 1 : code == m::kCounterClockwise ? -1 : 0;
    emit_spindle();
  }
  return true;
}

void Interpreter::set_coolant(const Step& step) {
  const int code = step.code(MGroup::coolant);
  if (code == kNoCode) {
    return;
  }
  const auto bits = static_cast<unsigned>(state_.coolant);
  const unsigned wanted = code == m::kCoolantOff ? 0U : code == m::kMist ? bits | 1U : bits | 2U;
  state_.coolant = static_cast<double>(wanted);
  emit_event(EventKind::coolant, state_.coolant);
}

bool Interpreter::set_override(const Step& step) {
  const int code = step.code(MGroup::override_switch);
  if (code == kNoCode) {
    return true;
  }
  const bool off = step.has('P') && step['P'] == 0.0;
  if (code == m::kOverridesOn || code == m::kOverridesOff) {
    state_.override_off = code == m::kOverridesOff;
  } else if (code == m::kFeedOverride) {
    state_.override_off = off;
  }
  // M51 rules the spindle override, M52 adaptive feed, M53 feed hold: no influence on the moves.
  return true;
}

bool Interpreter::stop(const Step& step) {
  const int code = step.code(MGroup::stopping);
  if (code == m::kEnd || code == m::kEndAndRewind) {
    if (!end_cutter(step)) {
      return false;
    }
    finished_ = true;
    emit_event(EventKind::end, 0.0);
  } else if (code != kNoCode) {
    const CutterCompensation::Fault fault = cutter_->stop(state_.unit_mm != 1.0);
    if (fault != CutterCompensation::Fault::none) {
      return cutter_fault(step, fault);
    }
    emit_event(EventKind::stop, code == m::kOptionalStop ? 1.0 : 0.0);
  }
  return true;
}

void Interpreter::emit_spindle() {
  const double speed = state_.surface_speed ? 0.0 : state_.spindle_speed_rev_s;
  emit_event(EventKind::spindle, state_.spindle_direction * speed);
}

void Interpreter::emit_event(EventKind kind, double value) {
  sink_->on_event({.kind = kind, .line = move_.line, .value = value, .tool_name = {}});
}

bool Interpreter::refuse_word(std::uint32_t line, const Word& word, std::string_view reason,
                              std::string_view text) {
  return refusals_.word(line, word, reason, text);
}

bool Interpreter::refuse(const Step& step, char letter, std::string_view reason,
                         std::string_view text) {
  return refusals_.letter(step, letter, reason, text);
}

bool Interpreter::refuse_code(const Step& step, char letter, int code, std::string_view reason,
                              std::string_view text) {
  return refusals_.code(step, letter, code, reason, text);
}

}  // namespace steadyrest::nc::interpret
