// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <steadyrest/nc/interpret/program_calls.hpp>
#include <steadyrest/nc/interpret/program_refusals.hpp>

namespace steadyrest::nc::interpret {

using read::Block;
using read::FlowKind;

bool ProgramCalls::refuse(const Block& block, std::string_view reason, std::string_view text) {
  refused_ = at_block(block, reason, text);
  return false;
}

void ProgramCalls::lose() {
  const FlowControl::Lost lost = parts_.flow.take_lost();
  if (lost != FlowControl::Lost::nothing && parts_.rules.variables != Variables::parameters) {
    parts_.macro.lose_all();
    parts_.typed.lose_all();
  }
  parts_.provenance.lose(lost);
}

bool ProgramCalls::follow(bool accepted) {
  const std::size_t calls = parts_.interpreter.parameters().calls();
  for (; calls_ < calls; ++calls_) {
    parts_.interpreter.enter_call();
    parts_.typed.enter(parts_.flow.values());
    parts_.macro.enter(std::exchange(locals_, MacroVariables::Locals::shared),
                       parts_.interpreter.program_call().arguments);
  }
  for (; calls_ > calls; --calls_) {
    parts_.interpreter.leave_call(parts_.sink);
    parts_.typed.leave();
    parts_.macro.leave();
  }
  if (!accepted) {
    refused_ = parts_.flow.refused();
  }
  return accepted;
}

bool ProgramCalls::after(const Block& block) {
  using Kind = Interpreter::ProgramCall::Kind;
  const Interpreter::ProgramCall& call = parts_.interpreter.program_call();
  FlowControl& flow = parts_.flow;
  bool accepted = true;
  switch (call.kind) {
    case Kind::none:
      if (parts_.interpreter.moved() && flow.modal_due()) {
        if (parts_.macro.macros() == MacroVariables::kDeepestMacro) {
          return refuse(block, "calls_too_deep", "macro calls nested more than four deep");
        }
        locals_ = MacroVariables::Locals::modal;
        accepted = follow(flow.call_modal(block.line()));
      }
      break;
    case Kind::end:
      accepted = end_of_subprogram(block);
      break;
    case Kind::call:
      if (call.unknown && parts_.rules.numbered_programs) {
        return refuse(block, "unknown_call",
                      "a call whose number or repeats the control decides: what it executes is not "
                      "known");
      }
      accepted =
          parts_.rules.numbered_programs
              ? follow(flow.call_numbered(block.line(), call.number, call.repeats))
              : call.repeats < 0.5 || follow(flow.call_program(
                                          block.line(), std::to_string(call.number), call.repeats));
      break;
    case Kind::macro:
    case Kind::modal:
    case Kind::modal_end:
      accepted = macro(block);
      break;
  }
  lose();
  return accepted;
}

// G65, G66, G67
bool ProgramCalls::macro(const Block& block) {
  using Kind = Interpreter::ProgramCall::Kind;
  const Interpreter::ProgramCall& call = parts_.interpreter.program_call();
  FlowControl& flow = parts_.flow;
  if (call.unknown) {
    return refuse(block, "unknown_call",
                  "a call whose number or repeats the control decides: what it executes is not "
                  "known");
  }
  if (call.kind == Kind::macro) {
    if (parts_.macro.macros() == MacroVariables::kDeepestMacro) {
      return refuse(block, "calls_too_deep", "macro calls nested more than four deep");
    }
    locals_ = MacroVariables::Locals::own;
    return follow(flow.call_numbered(block.line(), call.number, call.repeats));
  }
  read::Flow modal;
  modal.label.clear();
  modal.count = 0;
  if (call.kind == Kind::modal) {
    if (flow.modal()) {
      return refuse(block, "macro_call",
                    "a second modal macro call (G66) before G67 ends the first is not interpreted");
    }
    for (const char digit : std::to_string(call.number)) {
      modal.label.push(digit);
    }
    modal.repeats = call.repeats;
    parts_.macro.set_modal(call.arguments);
  }
  return follow(flow.set_modal(block.line(), modal));
}

// M99, M17 or RET: back to the caller, or to the head where the call repeats.
bool ProgramCalls::end_of_subprogram(const Block& block) {
  const std::int32_t target = parts_.interpreter.program_call().number;
  if (parts_.rules.named_calls && !parts_.flow.in_call()) {
    return refuse(block, "subprogram_end",
                  "the end of a subprogram (M17, RET) in the main program; end it with M30");
  }
  if (target != 0) {
    if (parts_.interpreter.program_call().unknown) {
      return refuse(block, "no_jump_target",
                    "M99 with a block number (P) that the control decides");
    }
    return follow(parts_.flow.end_program_at(block.line(), target));
  }
  const bool alike = parts_.macro.begins_alike();
  const std::size_t before = calls_;
  const bool accepted = follow(parts_.flow.end_program(block.line()));
  if (accepted && calls_ == before) {
    parts_.typed.restart();
    return alike || refuse(block, "macro_repeat",
                           "a macro with repeats (L) that changes its arguments: whether they "
                           "begin anew is not certain; call it once for each");
  }
  return accepted;
}

bool ProgramCalls::named(const Block& block) {
  const read::Flow& flow = block.flow();
  const bool modal = flow.kind == FlowKind::modal_call || flow.kind == FlowKind::modal_cycle;
  if (modal && flow.unknown != 0) {
    return refuse(block, "modal_call",
                  "a modal call (MCALL) with a value that the control decides");
  }
  bool accepted = true;
  if (flow.kind == FlowKind::call) {
    accepted = follow(parts_.flow.call_named(block.line(), flow));
  } else {
    // Any MCALL takes the place of the one before it.
    if (modal) {
      read::Flow none;
      none.label.clear();
      accepted = follow(
          parts_.flow.set_modal(block.line(), flow.kind == FlowKind::modal_call ? flow : none));
    }
    if (accepted && !parts_.interpreter.execute_cycle(block, parts_.sink)) {
      refused_ = parts_.interpreter.refused();
      accepted = false;
    }
    if (flow.unknown != 0) {
      parts_.provenance.lose(FlowControl::Lost::all);
    }
  }
  lose();
  return accepted;
}

}  // namespace steadyrest::nc::interpret
