// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// Sees only whether anything moves: modes are what a startup block is for.
class Moves final : public Sink {
 public:
  void on_move(const Move& move) override { any = any || move.start != move.end; }
  void on_event(const Event& /*event*/) override {}
  bool any = false;
};

}  // namespace

kernel::outcome::Result<void> Interpreter::start_up() {
  const std::string text = control_.config.settings.startup;
  if (text.empty()) {
    return {};
  }
  const auto bad = [&](std::string_view why) {
    return kernel::outcome::refuse(
        fmt::format("the control's startup block `{}`: {}", text, why),
        "correct startup in [program] of the machine file (RS274NGC_STARTUP_CODE in the INI file)");
  };
  read::Reader reader(control_.config.dialect);
  reader.set_values(&parameters_);
  read::Block block;
  Moves moves;
  if (!reader.read(text, 1, 0, block)) {
    return bad(fmt::format("`{}`: {}", reader.refused().word, reader.refused().text));
  }
  if (block.flow().kind != read::FlowKind::none) {
    return bad("an O-word or a call");
  }
  if (!execute(block, moves)) {
    return bad(fmt::format("`{}`: {}", refused().word, refused().text));
  }
  if (moves.any || finished_ || program_call_.kind != ProgramCall::Kind::none) {
    return bad("it moves, calls or ends a program; allowed: modes, F, S");
  }
  parameters_.asked().clear();
  plain_.forget();
  return {};
}

}  // namespace steadyrest::nc::interpret
