// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Labels, as on HEIDENHAIN controls: subprograms, repeated sections, jumps, called programs.
namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::FlowKind;

constexpr std::size_t kDeepestLabel = 19;  ///< subprograms and programs, TNC 640

/// `12 LBL 5`, `LBL "NAME"`: the label as the reader writes it; empty where the line has none.
std::string label_of(std::string_view line) {
  std::size_t at = 0;
  const auto skip = [&](auto is) {
    while (at < line.size() && is(line[at])) {
      ++at;
    }
  };
  const auto neither = [](char c) { return read::is_blank(c) || c == '/'; };
  skip(neither);
  at +=
      at + 1 < line.size() && read::upper(line[at]) == 'N' && read::is_digit(line[at + 1]) ? 1 : 0;
  skip(read::is_digit);
  skip(neither);
  constexpr std::string_view kWord = "LBL";
  const std::string_view rest = line.substr(at);
  if (rest.size() <= kWord.size() ||
      !std::ranges::equal(rest.substr(0, kWord.size()), kWord, {}, read::upper)) {
    return {};
  }
  at += kWord.size();
  skip(read::is_blank);
  if (at < line.size() && line[at] == '"') {
    const auto end = line.find('"', at + 1);
    return end == std::string_view::npos ? std::string{} : std::string{line.substr(at, end - at)};
  }
  skip([](char c) { return c == '+'; });
  const std::size_t digits = at;
  skip(read::is_digit);
  std::string_view number = line.substr(digits, at - digits);
  while (number.size() > 1 && number.front() == '0') {
    number.remove_prefix(1);
  }
  return std::string{number};
}

}  // namespace

bool FlowControl::refuse_mark(const Block& block, std::string_view reason, std::string_view text) {
  refuse(block.line(), {}, reason, text);
  const bool file = block.flow().kind == FlowKind::call_file;
  refused_.word = (file ? "CALL PGM " : "LBL ") + read::printable(block.flow().label.view());
  return false;
}

// One pass over the file notes all its labels; later calls and jumps need no search.
bool FlowControl::note_marks(std::uint32_t line) {
  const Place back = files_.line_end();
  if (!go(line, {.file = back.file, .line = 0, .offset = 0})) {
    return false;
  }
  while (files_.next() == read::LineSource::Status::line) {
    const std::string label = label_of(files_.now().line());
    if (label.empty() || label == "0") {
      continue;
    }
    const auto [known, fresh] = marks_.try_emplace({back.file, label}, files_.line_end());
    if (!fresh) {
      const std::uint32_t second = files_.now().number();
      refuse(second, {}, "label_twice",
             "a label that line " + std::to_string(known->second.line) + " has already");
      refused_.word = "LBL " + read::printable(label);
      return false;
    }
  }
  marked_files_.push_back(back.file);
  return go(line, back);
}

const Place* FlowControl::mark(const Block& block) {
  const std::uint32_t file = files_.line_end().file;
  if (std::ranges::find(marked_files_, file) == marked_files_.end() && !note_marks(block.line())) {
    return nullptr;
  }
  const auto found = marks_.find({file, std::string{block.flow().label.view()}});
  if (found == marks_.end()) {
    refuse_mark(block, "no_such_label", "the program has no such label (LBL)");
    return nullptr;
  }
  return &found->second;
}

bool FlowControl::call_mark(const Block& block) {
  const Place* const head = mark(block);
  if (head == nullptr) {
    return false;
  }
  if (block.flow().count != 0) {
    return repeat_section(block, *head);
  }
  if (frames_.size() > kDeepestLabel) {
    return refuse_mark(block, "calls_too_deep", "subprogram calls nested more than 19 deep");
  }
  return enter_numbered(block.line(), block.flow().label.view(), *head, 1.0);
}

// CALL LBL n REP r: what lies between the label and this line is executed r times more.
bool FlowControl::repeat_section(const Block& block, const Place& head) {
  auto& sections = frames_.back().sections;
  auto found = std::ranges::find(sections, block.line(), &std::pair<std::uint32_t, double>::first);
  if (found == sections.end()) {
    sections.emplace_back(block.line(), block.flow().values[0]);
    found = sections.end() - 1;
  }
  if (found->second < 0.5) {
    sections.erase(found);
    return true;
  }
  found->second -= 1.0;
  jumped_ = true;
  return go(block.line(), head);
}

// LBL 0 outside a call is passed over.
bool FlowControl::end_of_mark(const Block& block) {
  if (!in_call() || frames_.back().is_file) {
    return true;
  }
  return end_program(block.line());
}

bool FlowControl::jump_mark(const Block& block) {
  const Place* const head = mark(block);
  if (head == nullptr || block.flow().values[0] == 0.0) {
    return head != nullptr;
  }
  jumped_ = jumped_ || head->line <= block.line();
  return go(block.line(), *head);
}

// CALL PGM NAME.H: looked for in the folders, since those of the control are not here.
bool FlowControl::call_file(const Block& block) {
  if (frames_.size() > kDeepestLabel) {
    return refuse_mark(block, "calls_too_deep", "program calls nested more than 19 deep");
  }
  const std::string name{block.flow().label.view()};
  const bool has_tail = name.size() > 2 && name[name.size() - 2] == '.';
  const std::string stem = has_tail ? name.substr(0, name.size() - 2) : name;
  // The control ignores case, but many file systems do not.
  std::string big = stem;
  std::string small = stem;
  std::ranges::transform(stem, big.begin(), read::upper);
  std::ranges::transform(stem, small.begin(), read::lower);
  std::vector<std::string> names = {name};
  for (const std::string& one : {stem, big, small}) {
    names.push_back(one + ".H");
    names.push_back(one + ".h");
  }
  const auto file = files_.find(names);
  if (!file) {
    return refuse_mark(block, "no_such_program",
                       "the subprogram folders have no such program (NAME.H)");
  }
  if (!enter_numbered(block.line(), name, *file, 1.0)) {
    return false;
  }
  frames_.back().is_file = true;
  ++files_called_;
  return true;
}

bool FlowControl::end_file(const Block& block) {
  if (!frames_.back().is_file) {
    return refuse(block.line(), {}, "subprogram_end",
                  "the program ends in a subprogram; close it with LBL 0");
  }
  --files_called_;
  return end_program(block.line());
}

}  // namespace steadyrest::nc::interpret
