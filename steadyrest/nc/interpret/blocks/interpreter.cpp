// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/blocks/waits.hpp>
#include <steadyrest/nc/interpret/check/settings_check.hpp>
#include <steadyrest/nc/interpret/decode/codes.hpp>

namespace steadyrest::nc::interpret {

using kernel::outcome::refuse;
using read::Block;

kernel::outcome::Result<std::unique_ptr<Interpreter>> Interpreter::make(Config config) {
  // The whole configuration is checked here, so that execution can rely on it.
  for (const char letter : config.axes) {
    if (kAxisLetters.find(letter) == std::string_view::npos) {
      return refuse("axis letters `" + config.axes + "`", "name axes out of XYZABCUVW");
    }
  }
  if (config.active_offset >= kWorkOffsets) {
    return refuse("active work offset " + std::to_string(config.active_offset + 1),
                  "choose 1 (G54) to 9 (G59.3)");
  }
  // A word that already has a meaning would lose it.
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
  auto made = std::unique_ptr<Interpreter>(new Interpreter(std::move(config)));
  if (auto started = made->start_up(); !started) {
    return std::unexpected(started.error());
  }
  return made;
}

Interpreter::Interpreter(Config config) : control_(std::move(config)) {
  parameters_.bind(control_.state, control_.config);
  parameters_.keep(control_.config.numbers);
}

// One block: decode, choose its motion, check, act. False when it is refused; the state is then
// useless.
bool Interpreter::execute(const Block& block, Sink& sink) {
  program_call_.kind = ProgramCall::Kind::none;
  // `follows`: the previous block was plain, so the current move has everything but end and feed.
  const bool follows = plain_.forget();
  if (block.deleted() && control_.config.block_delete) {
    return true;
  }
  if (block.acting() == read::Acting::message) {
    out_.wait_for_rest();
  }
  // Comments, labels and empty lines are not blocks.
  if (block.words().empty() && !block.end_mark()) {
    return true;
  }
  cutter_.send_to(sink);
  if (block.end_mark() && corners_.waits()) {
    return corners_.refuse_end(block.line());
  }
  if (block.end_mark()) {
    finished_ = true;
    cutter_.end_mark(block.line());
    return true;
  }
  if (block.words().front().qualifier == read::Qualifier::fine) {
    return frames_.set_fine(block.words().front());
  }
  if (!decode(block)) {
    return false;
  }
  if (control_.rules.feed_may_be_missing && !(control_.state.feed_mm_s > 0.0)) {
    assume_feed(step_);
  }
  if (plain_.takes(step_)) {
    assumptions_.look(step_);
    return plain_.execute(step_, follows);
  }
  if (step_.frame != 0) {
    assumptions_.look(step_);
    return frames_.set(step_);
  }
  // The checks come before anything acts. Faults that show only during execution are refused there;
  // either way nothing runs after a refusal.
  if (!(check_.choose_motion(step_) && check_.check(step_) && check_rotary(step_, control_) &&
        frames_.settle(step_) && act(step_))) {
    return false;
  }
  // A modal cycle (MCALL) drills after each block that moves.
  return step_.moves_by < 0 || (step_.mask & kAxisMask) == 0 || cycle_calls_.after_move();
}

// sinumerik: CYCLE81(…) and MCALL have no words, so they bypass decoder and checks.
bool Interpreter::execute_cycle(const Block& block, Sink& sink) {
  if (block.deleted() && control_.config.block_delete) {
    return true;
  }
  cutter_.send_to(sink);
  control_.state.line = block.line();
  out_.begin_block(block.line());
  assumptions_.look_at_cycle(block);
  return cycle_calls_.call(block.flow());
}

bool Interpreter::end_of_file(std::uint32_t line, Sink& sink) {
  if (!control_.rules.file_ends_program) {
    return false;
  }
  cutter_.send_to(sink);
  cutter_.end_mark(line);
  finished_ = true;
  assumptions_.note_end(line);
  return true;
}

// grbl, mach3: a cut before the first F is at a feed left from before the program.
void Interpreter::assume_feed(const Step& step) noexcept {
  State& state = control_.state;
  const int own = step.code(GGroup::motion);
  const int motion = own == kNoCode ? state.motion : own;
  const bool cuts = (motion >= g::kLinear && motion <= g::kArcCounterClockwise) || is_cycle(motion);
  const bool per_minute = step.code(GGroup::feed_mode) == kNoCode
                              ? state.feed_mode == FeedMode::per_minute
                              : step.code(GGroup::feed_mode) == g::kPerMinute;
  const bool moves = (step.mask & kAxisMask) != 0 || (step.mask & kCentreMask) != 0;
  if (!cuts || !per_minute || !moves || (step.has('F') && step['F'] > 0.0) ||
      (step.code(GGroup::non_modal) != kNoCode && step.code(GGroup::motion) == kNoCode)) {
    return;
  }
  assumptions_.note_feed(step.line);
  constexpr double kAssumed_mm_s = 100.0 / 60.0;
  state.feed_mm_s = state.feed_deg_s = kAssumed_mm_s;
}

bool Interpreter::survey(const Block& block) {
  if (!block.words().empty() && block.words().front().qualifier == read::Qualifier::fine) {
    return true;
  }
  return decode(block);
}

// M73 restores the caller's modes at the end of its subprogram.
void Interpreter::leave_call(Sink& sink) {
  cutter_.send_to(sink);
  if (modes_.leave_call()) {
    plain_.forget();
  }
}

bool Interpreter::decode(const Block& block) {
  if (!check_remapped(block, control_)) {
    return false;
  }
  step_.reset(block);
  const bool accepted = control_.rules.decode(decoding_, block, step_);
  // fanuc: a motion word in the block of G28 or G53 only sets the mode; the axis words belong to
  // those.
  if (step_.motion_mode != kNoCode) {
    motion_in_force(step_.motion_mode);
  }
  return accepted;
}

// The order of execution within a block (README.md), that of RS274/NGC. It matters: a tool change
// comes before the new tool's offset, a dwell before the move, a stop after it.
bool Interpreter::act(const Step& step) {
  if (!corners_.permits(step) || !text_frames_.permits(step)) {
    return false;
  }
  out_.begin_block(step.line);
  assumptions_.look(step);
  if (step.modulation >= 0) {
    control_.state.speed_modulation = step.modulation == 1;
  }
  if (control_.rules.words_wait && waits_for_rest(step, control_.state)) {
    out_.wait_for_rest();
  }
  if (control_.rules.units_first) {
    modes_.units(step);
  }
  machine_.feed(step);
  if (!machine_.spindle_speed(step) || !machine_.select_tool(step)) {
    return false;
  }
  if (step.code(MGroup::tool_change) == m::kToolChange) {
    motion_.to_tool_change();
  }
  if (!machine_.change_tool(step) || !modes_.keep(step)) {
    return false;
  }
  machine_.spindle(step);
  machine_.coolant(step);
  machine_.overrides(step);
  if (!machine_.outputs(step)) {
    return false;
  }
  // A dwell waits for the spindle to reach speed and the coolant to flow.
  if (step.code(GGroup::non_modal) == g::kDwell) {
    out_.dwell(step['P']);
  }
  modes_.plane_and_units(step);
  if (!cutter_.set(step) || !offsets_.tool_length(step) || !offsets_.work_offset(step)) {
    return false;
  }
  modes_.path(step);
  modes_.distance_and_retract(step);
  return text_frames_.set(step) && non_modal(step) && text_frames_.settle(step) && move(step) &&
         call_program(step) && stop(step);
}

bool Interpreter::non_modal(const Step& step) {
  const int code = step.code(GGroup::non_modal);
  switch (code) {
    case g::kSetData:
      return data_.set(step);
    case g::kHome:
      motion_.home(step, 0);
      return true;
    case g::kSecondHome:
      motion_.home(step, static_cast<std::size_t>(std::max<int>(step.reference_point, 2) - 1));
      return true;
    case g::kStoreHome:
    case g::kStoreSecondHome:
      offsets_.store_home(code);
      return true;
    case g::kShift:
    case g::kSetOrigin:
      // fanuc: G92 S alone is a speed limit.
      return (step.mask & kAxisMask) == 0 || offsets_.origin(step, code);
    case g::kForgetOrigin:
    case g::kOriginOff:
    case g::kOriginOn:
      return offsets_.origin(step, code);
    default:
      return true;
  }
}

// Any of these ends a row of tapping cycles, and M29 with it.
void Interpreter::motion_in_force(int motion) noexcept {
  State& state = control_.state;
  state.rigid_tap = state.rigid_tap && !is_cycle(state.motion);
  state.motion = motion;
  state.plain_motion = motion;
}

// G80. On fanuc cycles are a group of their own (09): the motion word that was in force before them
// (group 01) is in force again.
void Interpreter::end_cycle() noexcept {
  State& state = control_.state;
  state.rigid_tap = false;
  state.motion = control_.rules.cycles_are_a_group ? state.plain_motion : g::kCycleEnd;
}

bool Interpreter::move(const Step& step) {
  const int motion = step.moves_by;
  if (step.code(GGroup::motion) == g::kCycleEnd) {
    end_cycle();
  }
  // No word of the block moves anything.
  if (motion == -1 || motion == g::kCycleEnd) {
    return true;
  }
  // fanuc: G53 leaves the motion word in force.
  if (step.machine_frame && control_.rules.machine_frame_is_rapid) {
    return motion_.straight(step);
  }
  if (step.has_fanuc && step.fanuc.pattern != kNoCode) {
    return patterns_.drill(step);
  }
  if (is_cycle(motion)) {
    return drilling_.cycle(step);
  }
  // Control points are collected until G5.3; any other motion in between would be lost.
  if (splines_.open() && motion != g::kSplinePoint && motion != g::kSplineEnd) {
    return control_.refusals.g_word(
        step, motion, "spline_words",
        "another motion between the control points of G5.2; end them with G5.3 first");
  }
  if (motion >= g::kCubicSpline && motion <= g::kSplineEnd) {
    return splines_.spline(step);
  }
  motion_in_force(motion);
  splines_.interrupt();
  switch (motion) {
    case g::kThread:
    case g::kRigidTap:
      return threading_.thread(step);
    case g::kThreadCycle:
      return threading_.cycle(step);
    case g::kProbeOrFail:
    case g::kProbe:
    case g::kProbeAwayOrFail:
    case g::kProbeAway:
      return motion_.probe(step);
    case g::kArcClockwise:
    case g::kArcCounterClockwise:
      return motion_.arc(step);
    default:
      return motion_.straight(step);
  }
}

bool Interpreter::call_program(const Step& step) {
  // program.cpp, which knows the lines, makes the call itself.
  const int code = step.code(MGroup::program);
  if (code == kNoCode) {
    return true;
  }
  program_call_.kind = code == m::kCall ? ProgramCall::Kind::call : ProgramCall::Kind::end;
  if (code == m::kReturn) {
    return true;
  }
  if (!step.has('P') || step['P'] != std::floor(step['P']) || step['P'] < 0.0) {
    return control_.refusals.m_word(step, 98, "word_missing",
                                    "M98 without the program's number (P)");
  }
  program_call_.number = static_cast<std::int32_t>(step['P']);
  program_call_.repeats = step.has('L') ? step['L'] : 1.0;
  return true;
}

// M2 and M30 end the program, M0, M1 and M60 stop it; the value marks M1, which the operator may
// disable.
bool Interpreter::stop(const Step& step) {
  const int code = step.code(MGroup::stopping);
  if (code == m::kEnd || code == m::kEndAndRewind) {
    // Moves waiting for cutter compensation must go out before the end and before a stop.
    if (!cutter_.end(step)) {
      return false;
    }
    finished_ = true;
    out_.event(EventKind::end, 0.0);
  } else if (code != kNoCode) {
    if (!cutter_.stop(step)) {
      return false;
    }
    out_.event(EventKind::stop, code == m::kOptionalStop ? 1.0 : 0.0);
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
