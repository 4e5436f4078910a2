// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Subprograms by number, as on FANUC controls.
namespace steadyrest::nc::interpret {
namespace {

// `O1234` or `:1234` at the beginning of a line.
std::optional<std::int32_t> program_number(std::string_view line) noexcept {
  std::size_t at = 0;
  const auto skip = [&] {
    while (at < line.size() && read::is_blank(line[at])) {
      ++at;
    }
  };
  skip();
  if (at == line.size() || (read::upper(line[at]) != 'O' && line[at] != ':')) {
    return std::nullopt;
  }
  ++at;
  skip();
  std::int32_t number = 0;
  std::size_t digits = 0;
  // Nine digits fit a 32-bit number; program numbers have four or five.
  for (; at < line.size() && read::is_digit(line[at]) && digits < 9; ++at, ++digits) {
    number = number * 10 + (line[at] - '0');
  }
  return digits == 0 ? std::nullopt : std::optional{number};
}

bool closes(std::string_view line) noexcept {
  const auto first = line.find_first_not_of(" \t\r");
  return first != std::string_view::npos && line[first] == '%';
}

std::vector<std::string> file_names(std::int32_t number) {
  const std::string plain = std::to_string(number);
  const std::string four = plain.size() < 4 ? std::string(4 - plain.size(), '0') + plain : plain;
  std::vector<std::string> names;
  // Controls write four digits with leading zeros; CAM systems often leave them out.
  for (const std::string& digits : {four, plain}) {
    for (const std::string_view head : {"O", "o", ""}) {
      for (const std::string_view tail : {"", ".nc", ".NC", ".ngc", ".tap", ".txt"}) {
        if (!(head.empty() && tail.empty())) {
          names.push_back(std::string{head}.append(digits).append(tail));
        }
      }
    }
  }
  return names;
}

}  // namespace

// Notes where the programs of a file begin: after the line with the number.
bool FlowControl::note_programs(std::uint32_t line, std::uint32_t file) {
  // One pass over the file notes every program in it; later calls need no search.
  const Place back = files_.line_end();
  if (!go(line, {.file = file, .line = 0, .offset = 0})) {
    return false;
  }
  while (files_.next() == read::LineSource::Status::line) {
    // The first line's % opens the file, a later one closes it.
    const std::string_view text = files_.now().line();
    if (closes(text) && files_.now().number() > 1) {
      break;
    }
    if (const auto number = program_number(text)) {
      // Of two programs with the same number the first counts.
      programs_.try_emplace(std::to_string(*number), files_.line_end());
    }
  }
  return go(line, back);
}

bool FlowControl::call_numbered(std::uint32_t line, std::int32_t number, double repeats) {
  const std::string label = std::to_string(number);
  if (frames_.size() > kDeepestCall) {
    return refuse(line, label, "calls_too_deep", "subprogram calls nested more than ten deep");
  }
  if (!programs_noted_ && !note_programs(line, 0)) {
    return false;
  }
  programs_noted_ = true;
  auto found = programs_.find(label);
  if (found == programs_.end()) {
    const auto file = files_.find(file_names(number));
    if (!file) {
      return refuse(
          line, label, "no_such_program",
          "no such subprogram in this file or in the subprogram folders; it is looked for as O" +
              label + " or O" + label + ".nc");
    }
    if (!note_programs(line, file->file)) {
      return false;
    }
    found = programs_.try_emplace(label, *file).first;
  }
  // M98 shares #1–#33 with its caller, so no arguments are set.
  return enter_numbered(line, label, found->second, repeats);
}

// Also for sinumerik's calls by name: no O-words, a head and a number of repeats.
bool FlowControl::enter_numbered(std::uint32_t line, std::string_view label, const Place& head,
                                 double repeats) {
  parameters_.enter_shared();
  frames_.push_back({.sub = std::string{label},
                     .back = files_.line_end(),
                     .head = head,
                     .left = repeats - 1.0,
                     .by_number = true,
                     .open = {}});
  return go(line, head);
}

bool FlowControl::call_named(const read::Block& block) {
  const std::string name{block.flow().label.view()};
  if (frames_.size() > kDeepestCall) {
    return refuse(block.line(), name, "calls_too_deep",
                  "subprogram calls nested more than ten deep");
  }
  // The control ignores case, but many file systems do not.
  std::string big = name;
  std::string small = name;
  std::ranges::transform(name, big.begin(), read::upper);
  std::ranges::transform(name, small.begin(), read::lower);
  std::vector<std::string> names;
  for (const std::string& stem : {name, big, small}) {
    for (const std::string_view tail : {".SPF", ".spf", ".MPF", ".mpf"}) {
      names.push_back(stem + std::string{tail});
    }
  }
  const auto file = files_.find(names);
  if (!file) {
    refuse(block.line(), name, "no_such_program",
           "an unknown word, and the subprogram folders have no NAME.SPF or NAME.MPF");
    refused_.word = name;
    return false;
  }
  return enter_numbered(block.line(), name, *file, block.flow().repeats);
}

}  // namespace steadyrest::nc::interpret
