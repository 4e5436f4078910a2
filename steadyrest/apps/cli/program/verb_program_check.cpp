// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_check.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>

namespace steadyrest::apps::cli {
namespace program_check {
namespace {

using nc::interpret::Move;
using nc::interpret::MoveKind;

/// The way of the cutting moves, mm: all of it, and what is in opaque stretches.
class CutLengths final : public nc::interpret::Sink {
 public:
  explicit CutLengths(nc::interpret::Sink& next) : next_(next) {}
  void on_move(const Move& move) override {
    if (move.kind != MoveKind::rapid && move.kind != MoveKind::dwell) {
      const double mm = nc::interpret::path_length(move);
      all_mm += mm;
      opaque_mm += move.opaque ? mm : 0.0;
    }
    next_.on_move(move);
  }
  void on_event(const nc::interpret::Event& event) override { next_.on_event(event); }
  double all_mm = 0.0;
  double opaque_mm = 0.0;

 private:
  nc::interpret::Sink& next_;
};

/// Nothing is ignored: a word that is not understood is listed with its line and the reason.
std::string text_of(const nc::interpret::Report& report, const CutLengths& cut) {
  if (report.refused.empty()) {
    std::string text = fmt::format("accepted: {} blocks, {} moves\n", report.blocks, report.moves);
    if (report.opaque_blocks > 0) {
      text += fmt::format(
          "not understood: {} blocks; {:.1f} of {:.1f} mm cut ({:.1f} %) depend on them\n",
          report.opaque_blocks, cut.opaque_mm, cut.all_mm,
          cut.all_mm > 0.0 ? 100.0 * cut.opaque_mm / cut.all_mm : 0.0);
    }
    return text;
  }
  Table table({"reason", "line", "word"});
  for (const nc::read::Refused& refused : report.refused) {
    table.row({refused.reason, fmt::format("{}", refused.line), refused.word});
  }
  return fmt::format("refused after {} blocks; not accepted:\n", report.blocks) + table.text();
}

struct Options {
  ProgramOptions program;
  std::string machine;  ///< empty: only the program's words are checked
};

/// The program is read by the rules of its dialect; the machine adds axis letters and limits.
Outcome run_on(const Options& options, const kernel::machine::Machine* machine,
               Progress& progress) {
  const auto config = machine == nullptr ? program_config(options.program)
                                         : program_config(options.program, *machine);
  if (!config) {
    return refused(config.error());
  }
  nc::interpret::NoMoves nothing;
  std::optional<nc::plan::MachineCheck> check;
  if (machine != nullptr) {
    check.emplace(*machine, known_of(options.program));
  }
  nc::interpret::Sink& sink = check ? static_cast<nc::interpret::Sink&>(*check) : nothing;
  CutLengths cut(sink);
  const auto report = run_program(options.program.file, *config, cut, progress);
  if (!report) {
    return refused(report.error());
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  if (machine != nullptr) {
    say_dialect(answer, options.program, *machine);
  }
  answer.json["moves"] = report->moves;
  answer.json["cut_mm"] = cut.all_mm;
  answer.json["opaque_cut_mm"] = cut.opaque_mm;
  answer.text = text_of(*report, cut) + put_assumed(answer, *report);
  if (check) {
    answer.text += put_warnings(answer, check->warnings(), check->count());
  }
  return answer;
}

/// Without a machine the dialect must be given, because one G code means different things on
/// different controls.
Outcome run(const Options& options, Progress& progress) {
  if (options.machine.empty() && options.program.dialect.empty()) {
    return refused(bad_input("--dialect is required",
                             "give --dialect, or --machine with the machine the program is for"));
  }
  if (options.machine.empty()) {
    return run_on(options, nullptr, progress);
  }
  const auto machine = read_machine(options.machine);
  return machine ? run_on(options, &*machine, progress) : std::unexpected(machine.error());
}

}  // namespace
}  // namespace program_check

void add_verb_program_check(Session& session, Verb& verb) {
  auto options = std::make_shared<program_check::Options>();
  add_program_options(verb, options->program);
  verb.get_option("--dialect")->required(false);
  verb.add_option("--machine", options->machine,
                  "Machine file: sets dialect and axes, and checks the program against travel, "
                  "feeds and spindle; add --variables and --tools for the full check")
      ->option_text("FILE");
  session.on(verb,
             [options](Progress& progress) { return program_check::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
