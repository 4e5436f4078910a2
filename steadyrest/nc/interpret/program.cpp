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
#include <steadyrest/nc/interpret/program_counter.hpp>
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
        provenance_(config, rules_.settable_frames, interpreter_->parameters()),
        block_delete_(config.block_delete),
        counter_(sink, report_) {
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
    return std::move(report_);
  }

 private:
  /// Before a line is read.
  void at_line() {
    asked().clear();
    executed_ = false;
    at_top_ = files_.in_main() && !flow_.repeating();
    in_main_ = files_.in_main();
    line_ = files_.now().number();
    interpreter_->at_line(line_);
    provenance_.at_line(line_, flow_.in_doubt(), flow_.repeating());
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
      return refuse(reader_.refused());
    }
    if (rules_.programs_in_a_row && !ends_in_order()) {
      return false;
    }
    if (rules_.named_calls && flow_.in_call() && typed_.values_left() &&
        !(block_.words().empty() && block_.flow().kind == read::FlowKind::none)) {
      return refuse(at_block(block_, "subprogram_call",
                             "a call with more values than the subprogram takes (PROC)"));
    }
    if (rules_.named_calls && block_.flow().kind != read::FlowKind::none) {
      return call();
    }
    if (block_.flow().kind != read::FlowKind::none && !(block_.deleted() && block_delete_)) {
      const bool accepted = follow(flow_.act(block_));
      provenance_.lose(flow_.take_lost());
      return accepted;
    }
    executed_ = !(block_.deleted() && block_delete_);
    if (executed_ && block_.acting() > read::Acting::message) {
      return refuse(acting_comment(block_, provenance_.known().doubt));
    }
    if (!interpreter_->execute(block_, counter_)) {
      return refuse(interpreter_->refused());
    }
    const bool plain = interpreter_->moved_alone() && reader_.numbers_alone();
    if (executed_ && !(plain && provenance_.settled())) {
      provenance_.executed(block_, interpreter_->state());
    }
    report_.blocks += block_.words().empty() ? 0U : 1U;
    if (rules_.named_calls && interpreter_->finished() && flow_.in_call()) {
      return refuse(at_block(block_, "subprogram_end",
                             "the end of a program in a subprogram; write M17 or RET"));
    }
    return program_call();
  }

  /// A call or an end of a subprogram that the block has asked for.
  bool program_call() {
    using Kind = Interpreter::ProgramCall::Kind;
    const Interpreter::ProgramCall& call = interpreter_->program_call();
    if (call.kind != Kind::call) {
      return call.kind == Kind::none || end_of_subprogram();
    }
    if (rules_.numbered_programs) {
      return follow(flow_.call_numbered(block_.line(), call.number, call.repeats));
    }
    return call.repeats < 0.5 ||
           follow(flow_.call_program(block_.line(), std::to_string(call.number), call.repeats));
  }

  /// A line that a condition, a count or a search skips.
  bool pass_over() {
    const bool branch = flow_.passing_branch();
    const bool accepted = follow(flow_.pass_over(block_));
    if (provenance_.known().doubt && branch && provenance_.passed_over(files_.now().line())) {
      flow_.skip_program_word();
    }
    provenance_.lose(flow_.take_lost());
    return accepted;
  }

  Asked& asked() noexcept {
    return rules_.variables == Variables::macros ? macro_.asked()
                                                 : interpreter_->parameters().asked();
  }

  // For two runs over nearly equal texts, side by side: a line that the other has just split into
  // words is not split again.
  bool same_as_ahead(const LineSource& source) noexcept {
    return ahead_ != nullptr && ahead_->executed_ && ahead_->files_.now().line() == source.line() &&
           ahead_->files_.now().ending_length() == source.ending_length() &&
           reader_.take(ahead_->reader_, ahead_->block_, source.number(), block_);
  }

  /// A cycle or subprogram by its name.
  bool call() {
    if (block_.deleted() && block_delete_) {
      return true;
    }
    if (block_.flow().kind == read::FlowKind::call) {
      return follow(flow_.call_named(block_));
    }
    ++report_.blocks;
    return interpreter_->execute_cycle(block_, counter_) || refuse(interpreter_->refused());
  }

  // M99, M17 or RET: back to the caller, or to the head where the call repeats.
  bool end_of_subprogram() {
    if (rules_.named_calls && !flow_.in_call()) {
      return refuse(
          at_block(block_, "subprogram_end",
                   "the end of a subprogram (M17, RET) in the main program; end it with M30"));
    }
    const bool accepted = follow(flow_.end_program(block_.line()));
    if (again_) {
      typed_.restart();
    }
    return accepted;
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

  /// Tells the interpreter of calls that began or ended.
  /// A call that ends and restarts in one step (M98 L, NAME P) leaves the depth unchanged.
  bool follow(bool accepted) {
    const std::size_t calls = interpreter_->parameters().calls();
    again_ = calls_ == calls;
    for (; calls_ < calls; ++calls_) {
      interpreter_->enter_call();
      typed_.enter(block_.flow());
    }
    for (; calls_ > calls; --calls_) {
      interpreter_->leave_call(counter_);
      typed_.leave();
    }
    return accepted || refuse(flow_.refused());
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
    switch (files_.next()) {
      case LineSource::Status::line:
        ++report_.lines;
        return true;
      case LineSource::Status::end:
        if (flow_.refuse_end()) {
          source_failed_ = true;
          return refuse(flow_.refused());
        }
        if (flow_.in_call() || !interpreter_->end_of_file(line_, counter_)) {
          refuse_end();
        }
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
  bool again_ = false;  ///< a subprogram restarts: neither entered nor left
  const DialectRules& rules_;
  Provenance provenance_;
  bool block_delete_;
  std::size_t calls_ = 0;
  Report report_;
  std::uint64_t moves_before_ = 0;  ///< of the current line
  Counter counter_;
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
