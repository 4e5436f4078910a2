// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>

namespace steadyrest::nc::interpret {

using read::Block;
using read::FlowKind;

// The main program has a frame like any call, so labels and open blocks need no special case.
FlowControl::FlowControl(ProgramFiles& files, Parameters& parameters, read::Reader& reader,
                         const Config& config)
    : files_(files),
      parameters_(parameters),
      reader_(reader),
      most_repeated_lines_(config.most_repeated_lines),
      frames_(1) {}

bool FlowControl::refuse(std::uint32_t line, std::string_view label, std::string_view reason,
                         std::string_view text) {
  refused_ = {.line = line,
              .word = label.empty() ? std::string{} : "O" + read::printable(label),
              .reason = std::string{reason},
              .text = std::string{text}};
  return false;
}

// Only loops and calls can make a finite file run forever, so only lines executed in them count. A
// cycle's moves count too, so every program's time is bounded.
bool FlowControl::count_line(std::uint64_t moves_before) {
  constexpr std::uint64_t kMovesOfALine = 100;  // a pecking cycle may make a million
  repeated_lines_ += repeating() ? 1 + moves_before / kMovesOfALine : 0;
  if (!repeating() || repeated_lines_ <= most_repeated_lines_) {
    return true;
  }
  return refuse(files_.now().number(), {}, "endless_program",
                "loops and subprograms execute more than " + std::to_string(most_repeated_lines_) +
                    " lines: the program does not seem to end");
}

// Skipping reads only O-words until the one that ends it. It needs the label, since blocks with
// other labels may lie in between.
void FlowControl::pass(Passing how, std::string_view label) {
  passing_ = how;
  passing_label_ = label;
  passing_from_ = files_.now().number();
  passing_in_doubt_ = false;
}

bool FlowControl::go(std::uint32_t line, const Place& place) {
  return files_.go(place) ||
         refuse(line, {}, "cannot_go_back",
                "a loop or call in a file that can only be read once; give a file, not a pipe");
}

// An executed O-word. Skipped lines go through pass_over() instead.
bool FlowControl::act(const Block& block) {
  switch (block.flow().kind) {
    case FlowKind::label:
      return !in_call() || frames_.back().by_number ||
             refuse(block.line(), block.flow().label.view(), "o_word_misplaced",
                    "a subprogram for M98 begins inside a subprogram for call");
    case FlowKind::none:
    case FlowKind::cycle:
    case FlowKind::modal_cycle:
      return true;
    case FlowKind::sub:
      return sub(block);
    case FlowKind::endsub:
    case FlowKind::back:
      return end_of_sub(block);
    case FlowKind::call:
      return call(block);
    case FlowKind::when:
      return condition(block);
    case FlowKind::elseif:
    case FlowKind::otherwise:
      return otherwise(block);
    case FlowKind::endif:
      return close(block, FlowKind::when);
    case FlowKind::loop_while:
      return head_of_while(block);
    case FlowKind::endwhile:
      return end_of_turn(block, FlowKind::loop_while, "endwhile without its while");
    case FlowKind::loop_do:
      return open(block, files_.line_end());
    case FlowKind::repeat:
      return head_of_repeat(block);
    case FlowKind::endrepeat:
      return end_of_turn(block, FlowKind::repeat, "endrepeat without its repeat");
    case FlowKind::leave_loop:
      return leave_loop(block);
    case FlowKind::next_turn:
      return next_turn(block);
    case FlowKind::mark:
      return true;
    case FlowKind::mark_end:
      return end_of_mark(block);
    case FlowKind::call_mark:
      return call_mark(block);
    case FlowKind::jump_mark:
      return jump_mark(block);
    case FlowKind::call_file:
      return call_file(block);
  }
  return true;
}

// Decides what ends the skipping of lines.
bool FlowControl::pass_over(Block& block) {
  const auto& source = files_.now();
  // Nothing after the closing % belongs to the program.
  if (reader_.ends_program(source.line())) {
    return !refuse_end();
  }
  if (!reader_.read_flow(source.line(), source.number(), block)) {
    refused_ = reader_.refused();
    return false;
  }
  const FlowKind kind = block.flow().kind;
  if (passing_ == Passing::to_endsub && (kind == FlowKind::sub || kind == FlowKind::label)) {
    return refuse(block.line(), block.flow().label.view(), "o_word_misplaced",
                  "a subprogram begins inside another one");
  }
  // LinuxCNC acts on these whether they are executed or not.
  if (kind == FlowKind::leave_loop || kind == FlowKind::next_turn) {
    Open* const loop = find(block, true);
    if (loop != nullptr && loop->kind == FlowKind::repeat) {
      return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                    "break or continue in a repeat; only while and do loops have them");
    }
  }
  skip_in_doubt(block);
  if (kind == FlowKind::none || block.flow().label.view() != passing_label_) {
    return true;
  }
  // LinuxCNC evaluates endsub and return even in a skipped definition and keeps the value; unset
  // arguments are not an error there.
  const bool ends_sub = kind == FlowKind::endsub || kind == FlowKind::back;
  const bool asks = passing_ == Passing::to_endsub      ? ends_sub
                    : passing_ == Passing::to_else      ? kind == FlowKind::elseif
                    : passing_ == Passing::to_condition ? kind == FlowKind::loop_while
                                                        : false;
  if (asks && !evaluate(block) && !(ends_sub && refused_.reason == "unset_parameter")) {
    return false;
  }
  switch (passing_) {
    case Passing::to_endsub:
      if (kind == FlowKind::endsub || kind == FlowKind::back) {
        const read::Flow& flow = block.flow();
        parameters_.record_value(flow.count == 1 ? flow.values.data() : nullptr, flow.unknown != 0);
      }
      if (kind == FlowKind::endsub) {
        passing_ = Passing::nothing;
      }
      return true;
    // The definition that a call was looking for: noted, so that the next call goes straight there.
    case Passing::to_sub:
    case Passing::to_program:
      if (kind == (passing_ == Passing::to_sub ? FlowKind::sub : FlowKind::label)) {
        passing_ = Passing::nothing;
        frames_.back().head = files_.line_end();
        (frames_.back().by_number ? programs_ : subs_)[passing_label_] = files_.line_end();
      }
      return true;
    default:
      return arrived(block);
  }
}

// What a skipped line would do where the control decides otherwise, beyond its words.
void FlowControl::skip_in_doubt(const Block& block) {
  if (!in_doubt()) {
    return;
  }
  switch (block.flow().kind) {
    case FlowKind::leave_loop:
    case FlowKind::next_turn:
      leave_in_doubt(find(block, true));
      break;
    case FlowKind::back:
      frames_.back().doubtful = true;
      break;
    case FlowKind::call:
      lose(Lost::all);
      break;
    default:
      break;
  }
}

// M98 or M99 in a skipped line.
void FlowControl::skip_program_word() noexcept {
  lose(Lost::all);
  frames_.back().doubtful = true;
}

// The label was found; whether this O-word ends the skipping depends on what was looked for.
bool FlowControl::arrived(Block& block) {
  const FlowKind kind = block.flow().kind;
  const auto ends = [&](FlowKind closing) {
    if (kind == closing) {
      passing_ = Passing::nothing;
    }
    return true;
  };
  switch (passing_) {
    case Passing::to_else:
      if (kind == FlowKind::elseif) {
        if (Open* const when = find(block, false); when != nullptr && block.flow().unknown != 0) {
          doubt(*when);
        }
        if (block.flow().values[0] != 0.0) {
          passing_ = Passing::nothing;
        }
        return true;
      }
      if (kind == FlowKind::endif) {
        passing_ = Passing::nothing;
        return close(block, FlowKind::when);
      }
      return ends(FlowKind::otherwise);
    case Passing::to_endif:
      ends(FlowKind::endif);
      return passing_over() || close(block, FlowKind::when);
    case Passing::to_endwhile:
      return ends(FlowKind::endwhile);
    case Passing::to_endrepeat:
      // LinuxCNC sees them here too: the label is the repeat's.
      if (kind == FlowKind::leave_loop || kind == FlowKind::next_turn) {
        return refuse(block.line(), block.flow().label.view(), "o_word_unmatched",
                      "break or continue in a repeat; only while and do loops have them");
      }
      return ends(FlowKind::endrepeat);
    case Passing::to_while:
      return ends(FlowKind::loop_while);
    case Passing::to_condition:
      ends(FlowKind::loop_while);
      return passing_over() || head_of_while(block);
    default:
      return true;
  }
}

// Skipping reads O-words without their values; here the value counts.
bool FlowControl::evaluate(Block& block) {
  const auto& source = files_.now();
  if (!reader_.read(source.line(), source.number(), source.ending_length(), block)) {
    refused_ = reader_.refused();
    return false;
  }
  return true;
}

// At the end of a file: whatever is still sought is missing, and a subprogram must have returned.
bool FlowControl::refuse_end() {
  if (passing_over()) {
    return !refuse(passing_from_, passing_label_, "o_word_without_end",
                   "the file ends before the O-word that matches this one (sub, endsub, else, "
                   "endif, endwhile, endrepeat or while)");
  }
  if (in_call()) {
    return !refuse(files_.now().number() - 1, frames_.back().sub, "o_word_without_end",
                   "the file ends in a subprogram; close it with endsub, M99 or LBL 0");
  }
  return false;
}

FlowControl::Open* FlowControl::find(const Block& block, bool loops_only) {
  auto& open = frames_.back().open;
  // From the innermost outwards; `continue` and `break` ignore the if they are in.
  const auto found = std::find_if(open.rbegin(), open.rend(), [&](const Open& one) {
    return one.label == block.flow().label.view() && !(loops_only && one.kind == FlowKind::when);
  });
  return found == open.rend() ? nullptr : &*found;
}

void FlowControl::drop_to(const Open& open) {
  auto& all = frames_.back().open;
  if (open.left) {
    lose(Lost::all);
  }
  all.erase(all.begin() + (&open - all.data()), all.end());
}

bool FlowControl::sub(const Block& block) {
  const std::string label{block.flow().label.view()};
  const auto known = subs_.find(label);
  if (in_call() || known != subs_.end()) {
    return refuse(block.line(), label, "o_word_misplaced",
                  in_call() ? "a subprogram begins inside another one"
                            : "this subprogram is already defined");
  }
  // A definition is not executed where it occurs: its place is noted, its lines are skipped.
  subs_[label] = files_.line_end();
  pass(Passing::to_endsub, label);
  return true;
}

bool FlowControl::call(const Block& block) {
  const read::Flow& flow = block.flow();
  if (frames_.size() > kDeepestLinuxcncCall) {
    return refuse(block.line(), flow.label.view(), "calls_too_deep",
                  "subprogram calls nested more than nine deep");
  }
  // Saves the caller's #1 to #30 before the subprogram can change them.
  parameters_.enter({flow.values.data(), flow.count}, flow.unknown);
  const std::string label{flow.label.view()};
  const bool unknown = (flow.unknown & read::Flow::kUnknownLabel) != 0;
  if (unknown) {  // another subprogram, perhaps
    any_doubt_ = true;
    lose(Lost::all);
  }
  return enter(
      block.line(), label, Passing::to_sub,
      {.sub = label, .back = files_.line_end(), .head = {}, .open = {}, .doubtful = unknown});
}

bool FlowControl::call_program(std::uint32_t line, std::string_view label, double repeats) {
  if (frames_.size() > kDeepestLinuxcncCall) {
    return refuse(line, label, "calls_too_deep", "subprogram calls nested more than nine deep");
  }
  parameters_.enter_shared();
  return enter(line, label, Passing::to_program,
               {.sub = std::string{label},
                .back = files_.line_end(),
                .head = {},
                .left = repeats - 1.0,
                .by_number = true,
                .open = {}});
}

bool FlowControl::enter(std::uint32_t line, std::string_view label, Passing how, Frame frame) {
  const auto& known = frame.by_number ? programs_ : subs_;
  const auto found = known.find(std::string{label});
  if (found != known.end()) {
    frame.head = found->second;
    frames_.push_back(std::move(frame));
    return go(line, found->second);
  }
  // Not seen so far: NAME.ngc if it exists, otherwise further down in this file. Either way lines
  // are skipped until its definition.
  frames_.push_back(std::move(frame));
  pass(how, label);
  const auto file = files_.find(label);
  return !file || go(line, *file);
}

bool FlowControl::end_of_sub(const Block& block) {
  const read::Flow& flow = block.flow();
  if (!in_call() || frames_.back().by_number ||
      (flow.kind == FlowKind::endsub && frames_.back().sub != flow.label.view())) {
    return refuse(block.line(), flow.label.view(), "o_word_unmatched",
                  "the end of a subprogram that is not being executed");
  }
  if (flow.kind == FlowKind::back && in_doubt(frames_.back())) {
    lose(Lost::all);
  }
  return leave(flow.count == 1 ? flow.values.data() : nullptr, flow.unknown != 0);
}

bool FlowControl::end_program(std::uint32_t line) {
  if (!in_call()) {
    return refuse(line, {}, "endless_program",
                  "M99 in the main program would restart it forever; end it with M30");
  }
  // M98 L5 executes the same frame five times: M99 returns to the head until none is left.
  Frame& frame = frames_.back();
  if (in_doubt(frame)) {
    lose(Lost::all);
  }
  if (frame.left > 0.5) {
    frame.left -= 1.0;
    frame.open.clear();
    return go(line, frame.head);
  }
  return leave(nullptr);
}

// Returns to the line after the call, with the caller's parameters.
bool FlowControl::leave(const double* returned, bool unknown) {
  const Place back = frames_.back().back;
  frames_.pop_back();
  parameters_.leave(returned, unknown);
  return go(back.line, back);
}

}  // namespace steadyrest::nc::interpret
