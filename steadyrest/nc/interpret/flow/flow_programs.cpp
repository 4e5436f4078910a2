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

// In the program's own file: %_N_NAME_SPF. A main program and its subprograms may come as one file.
std::optional<Place> FlowControl::program_of_file(std::uint32_t line, std::string_view name) {
  const ProgramMap* const map = map_here(line);
  std::optional<Place> place = map == nullptr ? std::nullopt : map->program(name);
  if (place) {
    place->file = files_.line_end().file;
  }
  return place;
}

bool FlowControl::call_named(std::uint32_t line, const read::Flow& call) {
  const std::string name{call.label.view()};
  if (frames_.size() > kDeepestCall) {
    return refuse(line, name, "calls_too_deep", "subprogram calls nested more than ten deep");
  }
  values_ = call;
  refused_ = {};
  std::optional<Place> place = program_of_file(line, name);
  if (!place && !refused_.reason.empty()) {
    return false;
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
  place = place ? place : files_.find(names);
  if (!place) {
    refuse(line, name, "no_such_program",
           "an unknown word, and the subprogram folders have no NAME.SPF or NAME.MPF");
    refused_.word = name;
    return false;
  }
  return enter_numbered(line, name, *place, values_.repeats);
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
    frame.sections.clear();
    return go(line, frame.head);
  }
  return leave(nullptr);
}

// Returns to the line after the call, with the caller's parameters.
bool FlowControl::leave(const double* returned, bool unknown) {
  const Place back = frames_.back().back;
  const bool doubtful = in_doubt(frames_.back());
  modal_running_ = modal_running_ && !frames_.back().modal;
  frames_.pop_back();
  carry_doubt_over(doubtful);
  parameters_.leave(returned, unknown);
  return go(back.line, back);
}

void FlowControl::set_modal(const read::Flow& call) {
  modal_ = call;
  modal_.kind = call.label.view().empty() ? read::FlowKind::none : read::FlowKind::call;
}

// Its own moves do not call it again.
bool FlowControl::call_modal(std::uint32_t line) {
  const bool numbered = read::is_digit(modal_.label.view().front());
  const auto number = [&] { return std::stoi(std::string{modal_.label.view()}); };
  values_ = modal_;
  if (!(numbered ? call_numbered(line, number(), modal_.repeats)
                 : call_named(line, modal_))) {
    return false;
  }
  frames_.back().modal = modal_running_ = true;
  return true;
}

}  // namespace steadyrest::nc::interpret
