// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>

// Jumps and repeated sections of the dialects whose files are mapped.
namespace steadyrest::nc::interpret {

using read::Block;
using read::FlowKind;
using read::Towards;

bool FlowControl::act_mapped(const Block& block) {
  // Reads the whole file when it is first needed: from here on the block's words are gone, but its
  // flow is its own.
  const ProgramMap* const map = map_of(block.line(), files_.line_end().file);
  if (map == nullptr) {
    return false;
  }
  switch (block.flow().kind) {
    case FlowKind::jump:
      return jump(block, *map);
    case FlowKind::section:
      return section(block, *map);
    default:
      return structure(block, *map);
  }
}

/// The map of a file; null when it is refused. The line that was read last is read again: its text
/// is asked for after the step.
const ProgramMap* FlowControl::map_of(std::uint32_t line, std::uint32_t file) {
  const auto known = maps_.find(file);
  if (known != maps_.end()) {
    return &known->second;
  }
  const Place before = files_.line_begin();
  const Place here = files_.line_end();
  if (!go(line, {.file = file, .line = 0, .offset = 0})) {
    return nullptr;
  }
  ProgramMap map;
  const bool noted = map.note(files_, reader_, block_delete_, refused_);
  const bool again = here.file == before.file && here.line == before.line + 1;
  if (!go(line, again ? before : here) ||
      (again && files_.next() != read::LineSource::Status::line) || !noted) {
    return nullptr;
  }
  return &maps_.emplace(file, std::move(map)).first->second;
}

// A fault in the file is refused where it is reached, not here.
void FlowControl::note_jumps() {
  if (reader_.maps()) {
    main_map_ = map_of(1, 0);
  }
}

bool FlowControl::refuse_target(std::uint32_t line, std::string_view name,
                                ProgramMap::Target::Found found) {
  const bool twice = found == ProgramMap::Target::Found::twice;
  refuse(line, {}, twice ? "jump_target_twice" : "no_jump_target",
         twice ? "two blocks of the program have the number of this jump: which of them is meant "
                 "depends on the control; number them differently"
               : "a jump to a block number or label that the program does not have in this "
                 "direction");
  refused_.word = read::printable(name);
  return false;
}

// The lines from `from` on, at least before `to`.
void FlowControl::doubt_lines(const ProgramMap& map, std::uint32_t from,
                              std::uint32_t to) noexcept {
  any_doubt_ = true;
  lose(Lost::all);
  Frame& frame = frames_.back();
  frame.doubt_to = std::max(frame.doubt_to, map.end_of_doubt(from, to));
  // Where a repeated section may be left, its end is not where the lines meet again.
  if (!frame.sections.empty() && frame.doubt_to > frame.sections.back().last_line + 1) {
    frame.doubt_to = ProgramMap::kToItsEnd;
  }
}

// A line can be executed again from here on, so lines count (count_line).
bool FlowControl::go_back(std::uint32_t line, const Place& place) {
  jumped_back_ = line;
  return go(line, place);
}

bool FlowControl::jump(const Block& block, const ProgramMap& map) {
  const read::Flow& flow = block.flow();
  const std::uint32_t line = block.line();
  if (flow.towards != Towards::start && flow.label.view().empty()) {
    // An assignment of which the control decides whether it is made.
    if (flow.unknown != 0) {
      lose(Lost::all);
    }
    return true;
  }
  if (!flow.holds && flow.unknown == 0) {
    return true;
  }
  const ProgramMap::Target target =
      flow.towards == Towards::start ? ProgramMap::Target{.found = ProgramMap::Target::Found::yes,
                                                          .place = map.start_of_program(line)}
                                     : map.find(flow.label.view(), line, flow.towards);
  const bool found = target.found == ProgramMap::Target::Found::yes;
  if (flow.unknown != 0) {
    // Another target, or none; one behind the jump bounds the doubt.
    const bool bounded =
        found && (flow.unknown & read::Flow::kUnknownLabel) == 0 && target.place.line >= line;
    doubt_lines(map, line + 1, bounded ? target.place.line + 1 : ProgramMap::kToItsEnd);
  }
  if (!flow.holds) {
    return true;
  }
  if (!found) {
    return flow.towards == Towards::if_there ||
           refuse_target(line, flow.label.view(), target.found);
  }
  return jump_to(line, map, target.place);
}

// Out of structures, which closes them, but not into one.
bool FlowControl::jump_to(std::uint32_t line, const ProgramMap& map, const Place& target) {
  Frame& frame = frames_.back();
  const std::size_t around = map.around(target.line + 1);
  std::size_t depth = frame.open.size();
  while (depth > 0 && frame.open[depth - 1].structure != around) {
    --depth;
  }
  if (depth == 0 && around != ProgramMap::kNone) {
    return refuse(line, {}, "jump_into_structure",
                  "a jump into a condition or loop, in line " + std::to_string(target.line + 1) +
                      "; controls allow jumps out of these only");
  }
  if (!frame.sections.empty() && (target.line < frame.sections.back().first.line ||
                                  target.line >= frame.sections.back().last_line)) {
    return refuse(line, {}, "jump_out_of_section",
                  "a jump out of a section that is being repeated (REPEAT)");
  }
  frame.open.resize(depth);
  Place place = target;
  place.file = files_.line_end().file;
  return place.line < line ? go_back(line, place) : go(line, place);
}

// Back in the caller: at one of its blocks.
bool FlowControl::end_program_at(std::uint32_t line, std::int32_t number) {
  const Place asked = files_.line_end();
  if (in_call()) {
    if (frames_.back().left > 0.5) {
      return refuse(line, {}, "flow_control",
                    "M99 P in a subprogram that is called with repeats (L): which of the two comes "
                    "first is not certain");
    }
    if (!end_program(line)) {
      return false;
    }
  }
  const ProgramMap* const map = map_of(line, files_.line_end().file);
  if (map == nullptr) {
    return false;
  }
  const std::string name = "N" + std::to_string(number);
  const std::uint32_t from = files_.line_end().line;
  const ProgramMap::Target target = map->find(name, from, Towards::anywhere);
  if (target.found == ProgramMap::Target::Found::yes) {
    return jump_to(from, *map, target.place);
  }
  // In the line of the return, unless that is in another file.
  const bool same_file = asked.file == files_.line_end().file;
  return refuse_target(same_file ? line : from, name, target.found);
}

// REPEATB LABEL P=n: its block. REPEAT LABEL P=n: from there to here. REPEAT A B P=n: from A to the
// block B. The labels are looked for towards the beginning first ("Job planning", "Repeating
// program sections"). The section itself is executed n times more.
bool FlowControl::section(const Block& block, const ProgramMap& map) {
  const read::Flow& flow = block.flow();
  const std::uint32_t line = block.line();
  const auto place_of = [&](std::string_view name, std::uint32_t from, bool ahead) {
    auto found = map.find(name, from, ahead ? Towards::end : Towards::beginning);
    if (found.found == ProgramMap::Target::Found::no && !ahead) {
      found = map.find(name, from, Towards::end);
    }
    return found;
  };
  const ProgramMap::Target first = place_of(flow.label.view(), line, false);
  if (first.found != ProgramMap::Target::Found::yes) {
    return refuse_target(line, flow.label.view(), first.found);
  }
  const bool one_block = flow.towards == Towards::anywhere;
  std::uint32_t last = one_block ? first.place.line + 1 : line - 1;
  if (!flow.second.view().empty()) {
    // ENDLABEL is the next one behind the section's beginning.
    const auto end = place_of(flow.second.view(), first.place.line, true);
    if (end.found != ProgramMap::Target::Found::yes) {
      return refuse_target(line, flow.second.view(), end.found);
    }
    last = end.place.line + 1;
  }
  const bool holds_itself = first.place.line < line && last >= line;
  if (last < first.place.line + 1 || holds_itself ||
      map.around(first.place.line + 1) != map.around(line) ||
      (map.around(last + 1) != map.around(line) && !one_block)) {
    return refuse(line, {}, "bad_section",
                  "a section to repeat that does not end before or begin behind this block, or is "
                  "not in the same condition or loop");
  }
  if (flow.unknown != 0) {
    doubt_lines(map, line + 1, line + 1);
    frames_.back().doubt_to = ProgramMap::kToItsEnd;
  }
  const double turns = flow.repeats;
  if (turns < 0.5) {
    return true;
  }
  constexpr std::size_t kDeepest = 100;
  if (frames_.back().sections.size() == kDeepest) {
    return refuse(line, {}, "sections_too_deep", "repeated sections nested more than 100 deep");
  }
  const Place back = files_.line_end();
  Place place = first.place;
  place.file = back.file;
  frames_.back().sections.push_back(
      {.first = place, .last_line = last, .back = back, .left = turns - 1.0});
  return go_back(line, place);
}

bool FlowControl::end_of_section() {
  auto& sections = frames_.back().sections;
  while (!sections.empty()) {
    Section& top = sections.back();
    const Place here = files_.line_end();
    if (here.file != top.first.file || here.line != top.last_line) {
      return true;
    }
    if (top.left > 0.5) {
      top.left -= 1.0;
      return go(here.line, top.first);
    }
    const Place back = top.back;
    sections.pop_back();
    if (!go(here.line, back)) {
      return false;
    }
  }
  return true;
}

// Whether a subprogram came back to this block or to another one was in doubt.
void FlowControl::carry_doubt_over(bool doubtful) noexcept {
  if (doubtful && reader_.maps()) {
    frames_.back().doubtful = true;
  }
}

}  // namespace steadyrest::nc::interpret
