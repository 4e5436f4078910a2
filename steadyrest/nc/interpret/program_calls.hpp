// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/flow/flow_control.hpp>
#include <steadyrest/nc/interpret/parameters/macro_variables.hpp>
#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>
#include <steadyrest/nc/interpret/provenance/provenance.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// The calls of a program: keeps the flow, the variables of a call and the saved modes in step.
/// Each function returns false where the program is refused: see refused().
class ProgramCalls {
 public:
  /// What must follow one another; all outlive the object.
  struct Parts {
    FlowControl& flow;
    Interpreter& interpreter;
    MacroVariables& macro;
    SinumerikVariables& typed;
    Provenance& provenance;
    const DialectRules& rules;
    Sink& sink;
  };
  explicit ProgramCalls(Parts parts) noexcept : parts_(parts) {}

  /// Tells the interpreter and the variables of calls that began or ended. A call that ends and
  /// restarts in one step (M98 L, NAME P) leaves the depth unchanged.
  bool follow(bool accepted);
  /// A call or an end of a subprogram that an executed block has asked for, or that a modal call
  /// makes behind it.
  bool after(const read::Block& block);
  /// There is no such call: nearly always.
  [[nodiscard]] bool idle() const noexcept {
    return parts_.interpreter.program_call().kind == Interpreter::ProgramCall::Kind::none &&
           !parts_.flow.modal();
  }
  /// A cycle or subprogram by its name (sinumerik).
  bool named(const read::Block& block);
  /// Passes on what the flow has lost.
  void lose();

  [[nodiscard]] const read::Refused& refused() const noexcept { return refused_; }

 private:
  bool refuse(const read::Block& block, std::string_view reason, std::string_view text);
  bool end_of_subprogram(const read::Block& block);
  bool macro(const read::Block& block);

  Parts parts_;
  std::size_t calls_ = 0;
  MacroVariables::Locals locals_ = MacroVariables::Locals::shared;  ///< of the next call
  read::Refused refused_;
};

}  // namespace steadyrest::nc::interpret
