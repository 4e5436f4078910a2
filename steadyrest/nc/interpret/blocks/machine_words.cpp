// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>

// M words beside spindle, coolant and stops: outputs and inputs, kept modes, programs by number.
namespace steadyrest::nc::interpret {

// M62 to M68 move nothing. An input (M66) is taken to answer 0, as rs274 does: what it really says
// only the machine knows.
bool Interpreter::set_io(const Step& step) {
  const int code = step.code(MGroup::io);
  if (code >= m::kOutputOnWithMove && code <= m::kOutputOff && !step.has('P')) {
    return refuse_code(step, 'M', code, "word_missing", "an output without its number (P)");
  }
  if (code == m::kWaitForInput && step.has('P') == step.has('E')) {
    return refuse_code(step, 'M', code, "word_missing",
                       "M66 needs the number of one input: P (digital) or E (analog)");
  }
  if ((code == m::kAnalogWithMove || code == m::kAnalog) && !(step.has('E') && step.has('Q'))) {
    return refuse_code(step, 'M', code, "word_missing",
                       "an analog output without its number (E) or value (Q)");
  }
  return true;
}

bool Interpreter::keep_modes(const Step& step) {
  const int code = step.code(MGroup::modes);
  KeptModes& kept = kept_.back();
  switch (code) {
    case m::kKeepModes:
    case m::kKeepModesForCall:
      kept = {.state = state_, .restores_itself = code == m::kKeepModesForCall};
      return true;
    case m::kForgetModes:
      kept = {};
      return true;
    case m::kRestoreModes:
      if (!kept.state) {
        return refuse_code(step, 'M', 72, "modes_not_kept",
                           "M72 where no modes are kept; M70 or M73 comes before, in the same "
                           "subprogram");
      }
      restore_modes(*kept.state);
      return true;
    default:
      return true;
  }
}

// All modes but that of motion; positions and offsets' values are not modes.
void Interpreter::restore_modes(const State& kept) {
  plain_before_ = false;
  state_.unit_mm = kept.unit_mm;
  state_.feed_unit_mm = kept.feed_unit_mm;
  state_.plane = kept.plane;
  state_.incremental = kept.incremental;
  state_.centre_absolute = kept.centre_absolute;
  state_.retract_to_initial = kept.retract_to_initial;
  state_.diameter = kept.diameter;
  state_.feed_mode = kept.feed_mode;
  state_.feed_mm_s = kept.feed_mm_s;
  state_.feed_deg_s = kept.feed_deg_s;
  state_.path_mode = kept.path_mode;
  state_.path_tolerance_mm = kept.path_tolerance_mm;
  state_.override_off = kept.override_off;
  state_.surface_speed = kept.surface_speed;
  state_.surface_speed_mm_s = kept.surface_speed_mm_s;
  state_.spindle_limit_rev_s = kept.spindle_limit_rev_s;
  state_.spindle_speed_rev_s = kept.spindle_speed_rev_s;
  state_.tool_offset = kept.tool_offset;
  if (state_.active_offset != kept.active_offset) {
    state_.active_offset = kept.active_offset;
    state_.work_in_force = state_.work_offset[kept.active_offset];
  }
  if (state_.spindle_direction != kept.spindle_direction) {
    state_.spindle_direction = kept.spindle_direction;
    emit_spindle();
  }
  if (state_.coolant != kept.coolant) {
    state_.coolant = kept.coolant;
    emit_event(EventKind::coolant, state_.coolant);
  }
  update_offset();
}

void Interpreter::enter_call() {
  kept_.emplace_back();
}

void Interpreter::leave_call(Sink& sink) {
  const KeptModes kept = kept_.back();
  kept_.pop_back();
  if (kept.state && kept.restores_itself) {
    cutter_->bind(sink);
    sink_ = state_.cutter_side != 0 ? static_cast<Sink*>(cutter_.get()) : &sink;
    restore_modes(*kept.state);
  }
}

bool Interpreter::call_program(const Step& step) {
  const int code = step.code(MGroup::program);
  if (code == kNoCode) {
    return true;
  }
  program_call_.kind = code == m::kCall ? ProgramCall::Kind::call : ProgramCall::Kind::end;
  if (code == m::kReturn) {
    return true;
  }
  if (!step.has('P') || step['P'] != std::floor(step['P']) || step['P'] < 0.0) {
    return refuse_code(step, 'M', 98, "word_missing", "M98 without the program's number (P)");
  }
  program_call_.number = static_cast<std::int32_t>(step['P']);
  program_call_.repeats = step.has('L') ? step['L'] : 1.0;
  return true;
}

}  // namespace steadyrest::nc::interpret
