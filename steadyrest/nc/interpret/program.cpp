// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/flow/flow_control.hpp>
#include <steadyrest/nc/interpret/flow/program_files.hpp>
#include <steadyrest/nc/interpret/parameters/macro_variables.hpp>
#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/program_calls.hpp>
#include <steadyrest/nc/interpret/program_counter.hpp>
#include <steadyrest/nc/interpret/program_fence.hpp>
#include <steadyrest/nc/interpret/program_refusals.hpp>
#include <steadyrest/nc/interpret/provenance/provenance.hpp>
#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::LineSource;
using read::Reader;
using read::Refused;

}  // namespace

// One line at a time: read it; then it controls the flow (O-words, calls) or is executed. The first
// refusal ends the run; survey() only adds other unknown words of the text.
class ProgramRun::Run {
 public:
  Run(LineSource& source, const Config& config, std::unique_ptr<Interpreter> interpreter,
      Sink& sink)
      : files_(source, config.subprogram_folders),
        reader_(config.dialect),
        interpreter_(std::move(interpreter)),
        flow_(files_, interpreter_->parameters(), reader_, config),
        macro_(interpreter_->state()),
        rules_(rules_of(config.dialect)),
        provenance_(config, rules_, interpreter_->parameters()),
        block_delete_(config.block_delete),
        counter_(sink, report_),
        fence_(config, {.files = files_,
                        .interpreter = *interpreter_,
                        .provenance = provenance_,
                        .counter = counter_,
                        .lose_values =
                            [this] {
                              macro_.lose_all();
                              typed_.lose_all();
                            }}),
        calls_({.flow = flow_,
                .interpreter = *interpreter_,
                .macro = macro_,
                .typed = typed_,
                .provenance = provenance_,
                .rules = rules_,
                .sink = counter_}) {
    switch (rules_.variables) {
      case Variables::parameters:
        reader_.set_values(&interpreter_->parameters());
        break;
      case Variables::macros:
        reader_.set_values(&macro_);
        break;
      case Variables::typed:
        reader_.set_typed_values(&typed_);
        break;
    }
    reader_.set_block_delete(config.block_delete);
    macro_.note_unknown(provenance_.known());
    typed_.note_unknown(provenance_.known());
    typed_.bind(interpreter_->state());
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() = default;

  // False at the end of the program, at the first refusal and where the source ends.
  bool step() { return !interpreter_->finished() && next_line() && line(); }

  // A refused program is searched for further unknown words, except where lines are missing or a
  // subprogram's file is being read: the rest would not be the user's program.
  Report take() {
    report_.assumed = interpreter_->assumed();
    if (!report_.refused.empty() && !source_failed_ && files_.in_main()) {
      survey();
    }
    report_.subprograms = files_.subprograms();
    report_.unknown = std::move(provenance_.known().assumed);
    report_.opaque_blocks = provenance_.stretches().blocks();
    report_.opaque = provenance_.stretches().take();
    return std::move(report_);
  }

 private:
  /// Before a line is read.
  void at_line() {
    asked().clear();
    executed_ = false;
    in_main_ = files_.in_main();
    line_ = files_.now().number();
    at_top_ = in_main_ && !flow_.repeating() && !flow_.may_repeat(line_);
    interpreter_->at_line(line_);
    provenance_.at_line(line_, flow_.in_doubt(), flow_.repeating());
    fence_.at_line();
  }

  /// False when it is refused.
  /// More values than PROC takes show at the subprogram's first block after PROC.
  bool line() {
    if (!flow_.count_line(report_.moves - std::exchange(moves_before_, report_.moves))) {
      return refuse(flow_.refused());
    }
    at_line();
    if (flow_.passing_over()) {
      return pass_over();
    }
    const LineSource& source = files_.now();
    if (!same_as_ahead(source) &&
        !reader_.read(source.line(), source.number(), source.ending_length(), block_)) {
      return not_understood(reader_.refused());
    }
    fence_.take_declared(block_);
    if (rules_.programs_in_a_row && !ends_in_order()) {
      return false;
    }
    if (rules_.named_calls && flow_.in_call() && typed_.values_left() &&
        !(block_.words().empty() && block_.flow().kind == read::FlowKind::none)) {
      return refuse(at_block(block_, "subprogram_call",
                             "a call with more values than the subprogram takes (PROC)"));
    }
    if (block_.flow().kind != read::FlowKind::none && !(block_.deleted() && block_delete_)) {
      const bool accepted = flow();
      calls_.lose();
      return accepted;
    }
    executed_ = !(block_.deleted() && block_delete_);
    if (executed_ && block_.acting() > read::Acting::message) {
      return not_understood(acting_comment(block_, provenance_.known().doubt));
    }
    if (!interpreter_->execute(block_, counter_) && !fence_.without_functions(block_)) {
      return not_understood(interpreter_->refused());
    }
    const bool plain = interpreter_->moved_alone() && reader_.numbers_alone();
    if (executed_ && !(plain && provenance_.settled())) {
      provenance_.executed(block_, interpreter_->state());
    }
    fence_.executed(block_);
    report_.blocks += block_.words().empty() ? 0U : 1U;
    if (rules_.named_calls && interpreter_->finished() && flow_.in_call()) {
      return refuse(at_block(block_, "subprogram_end",
                             "the end of a program in a subprogram; write M17 or RET"));
    }
    return calls_.idle() || !executed_ || calls_.after(block_) || not_understood(calls_.refused());
  }

  /// A block that says what comes next.
  bool flow() {
    switch (block_.flow().kind) {
      case read::FlowKind::cycle:
      case read::FlowKind::modal_cycle:
      case read::FlowKind::modal_call:
        ++report_.blocks;
        if (block_.flow().label.view().empty()) {
          provenance_.no_modal_call();
        }
        return calls_.named(block_) || not_understood(calls_.refused());
      case read::FlowKind::call:
        if (rules_.named_calls) {
          return calls_.named(block_) || not_understood(calls_.refused());
        }
        break;
      default:
        break;
    }
    return calls_.follow(flow_.act(block_)) || refuse(calls_.refused());
  }

  /// A line that a condition, a count or a search skips.
  bool pass_over() {
    const bool branch = flow_.passing_branch();
    const bool accepted = calls_.follow(flow_.pass_over(block_)) || refuse(calls_.refused());
    if (provenance_.known().doubt && branch && provenance_.passed_over(files_.now().line())) {
      flow_.skip_program_word();
    }
    calls_.lose();
    return accepted;
  }

  Asked& asked() noexcept {
    return rules_.variables == Variables::macros  ? macro_.asked()
           : rules_.variables == Variables::typed ? typed_.asked()
                                                  : interpreter_->parameters().asked();
  }

  // For two runs over nearly equal texts, side by side: a line that the other has just split into
  // words is not split again.
  bool same_as_ahead(const LineSource& source) noexcept {
    return ahead_ != nullptr && ahead_->executed_ && ahead_->files_.now().line() == source.line() &&
           ahead_->files_.now().ending_length() == source.ending_length() &&
           reader_.take(ahead_->reader_, ahead_->block_, source.number(), block_);
  }

  /// A subprogram must end with its word, and a program before the next one begins. On fanuc and
  /// sinumerik the end of a program is a word; the flow checks LinuxCNC's O-words.
  bool ends_in_order() {
    const bool label = block_.flow().kind == read::FlowKind::label;
    if (block_.end_mark() && !files_.in_main() && block_.line() == 1) {
      block_.reset(1);  // % at the head of a subprogram's file
      return true;
    }
    if (!(flow_.in_call() && (block_.end_mark() || label)) && !(label && report_.blocks > 0)) {
      return true;
    }
    return refuse(at_block(block_, "no_program_end",
                           "the program or subprogram above has no end; write M30 or M99",
                           label ? "O" : "%"));
  }

  /// A block of which nothing has acted opens an opaque stretch, or refuses the program.
  bool not_understood(const Refused& refused) {
    if (!fence_.opens(block_, refused)) {
      return refuse(refused);
    }
    executed_ = !(block_.deleted() && block_delete_);
    report_.blocks += executed_ ? 1U : 0U;
    return true;
  }

  bool refuse(const Refused& refused) {
    report_.refused.push_back(refused);
    if (!files_.in_main()) {
      report_.refused.back().file = files_.path();
    }
    return false;
  }

  // The end of the file is a refusal unless the program has ended: half a program must not pass as
  // a whole one.
  bool next_line() {
    if (!flow_.between_lines()) {
      return refuse(flow_.refused());
    }
    switch (files_.next()) {
      case LineSource::Status::line:
        ++report_.lines;
        return true;
      case LineSource::Status::end:
        if (flow_.refuse_end()) {
          source_failed_ = true;
          return refuse(flow_.refused());
        }
        refuse_end();
        return false;
      case LineSource::Status::too_long:
        refuse_source("line_too_long",
                      "a line of more than 65536 bytes; this is not an NC program");
        return false;
      case LineSource::Status::failed:
        refuse_source("read_failed", "the file could not be read to its end");
        return false;
    }
    return false;
  }

  void refuse_source(std::string_view reason, std::string_view text) {
    source_failed_ = true;
    report_.refused.push_back({.line = files_.now().number(),
                               .word = {},
                               .reason = std::string{reason},
                               .text = std::string{text}});
  }

  void refuse_end() {
    const std::string_view text =
        reader_.percent_opened()
            ? "the file ends before the program: end it with M2 or M30, or with % as it began"
            : "the file ends before the program: end it with M2 or M30";
    refuse_source("no_program_end", text);
    report_.refused.back().line = line_;
  }

  // Other faults in the program: text and vocabulary only, since the state after a refused block is
  // unknown.
  void survey() {
    while (report_.refused.size() < Report::kMostRefused &&
           files_.next() == LineSource::Status::line) {
      ++report_.lines;
      const LineSource& source = files_.now();
      // The values here are unknown.
      if (source.line().find_first_of("#[") != std::string_view::npos) {
        continue;
      }
      if (!reader_.read(source.line(), source.number(), source.ending_length(), block_)) {
        add_kind(report_, reader_.refused());
      } else if (!block_.words().empty() && !interpreter_->survey(block_)) {
        add_kind(report_, interpreter_->refused());
      }
    }
  }

  ProgramFiles files_;
  Reader reader_;
  std::unique_ptr<Interpreter> interpreter_;
  FlowControl flow_;
  MacroVariables macro_;
  SinumerikVariables typed_;
  const DialectRules& rules_;
  Provenance provenance_;
  bool block_delete_;
  Report report_;
  std::uint64_t moves_before_ = 0;  ///< of the current line
  Counter counter_;
  ProgramFence fence_;
  ProgramCalls calls_;
  Block block_;
  bool source_failed_ = false;
  std::uint32_t line_ = 0;
  bool executed_ = false;
  bool at_top_ = false;
  bool in_main_ = true;
  const Run* ahead_ = nullptr;  ///< runs the same lines

  friend class ProgramRun;
};

ProgramRun::ProgramRun(std::unique_ptr<Run> run) : run_(std::move(run)) {}
ProgramRun::ProgramRun(ProgramRun&& other) noexcept = default;
ProgramRun::~ProgramRun() = default;

kernel::outcome::Result<ProgramRun> ProgramRun::make(LineSource& source, const Config& config,
                                                     Sink& sink) {
  auto interpreter = Interpreter::make(config);
  if (!interpreter) {
    return std::unexpected(interpreter.error());
  }
  return ProgramRun(std::make_unique<Run>(source, config, std::move(*interpreter), sink));
}

bool ProgramRun::step() {
  return run_->step();
}
void ProgramRun::read_with(const ProgramRun& other) {
  run_->ahead_ = other.run_.get();
}
void ProgramRun::note_jumps() {
  run_->flow_.note_jumps();
}
Report ProgramRun::take() {
  return run_->take();
}
std::uint32_t ProgramRun::line() const noexcept {
  return run_->line_;
}
bool ProgramRun::executed() const noexcept {
  return run_->executed_;
}
// The line was plain and its values were numbers: only position, motion and feed can have changed.
bool ProgramRun::moved_alone() const noexcept {
  return run_->executed_ && run_->interpreter_->moved_alone() && run_->reader_.numbers_alone();
}
bool ProgramRun::at_top() const noexcept {
  return run_->at_top_;
}
bool ProgramRun::in_main() const noexcept {
  return run_->in_main_;
}
const Block& ProgramRun::block() const noexcept {
  return run_->block_;
}
bool ProgramRun::at_opaque() const noexcept {
  return run_->provenance_.at_opaque();
}
Doubt ProgramRun::doubt() const noexcept {
  return run_->provenance_.doubt();
}
const std::vector<Assumed>& ProgramRun::unknown() const noexcept {
  return run_->provenance_.known().assumed;
}
const Asked& ProgramRun::asked() const noexcept {
  return run_->asked();
}

// What the control would keep after the program; rewrite compares it.
ProgramRun::Kept ProgramRun::kept() const {
  Kept kept{.tools = run_->interpreter_->tools().value_or(std::vector<Tool>{}), .variables = {}};
  switch (run_->rules_.variables) {
    case Variables::parameters:
      run_->interpreter_->parameters().list(kept.variables);
      break;
    case Variables::macros:
      run_->macro_.list(kept.variables);
      break;
    case Variables::typed:
      run_->typed_.list(kept.variables);
      break;
  }
  return kept;
}
const State& ProgramRun::state() const noexcept {
  return run_->interpreter_->state();
}

}  // namespace steadyrest::nc::interpret
