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

bool FlowControl::call_numbered(std::uint32_t line, std::int32_t number, double repeats) {
  const std::string label = std::to_string(number);
  if (frames_.size() > kDeepestCall) {
    return refuse(line, label, "calls_too_deep", "subprogram calls nested more than ten deep");
  }
  // The program's own file first, then those that calls have opened, in their order.
  if (map_of(line, 0) == nullptr) {
    return false;
  }
  const auto in_file = [&](std::uint32_t file) {
    std::optional<Place> place = maps_.at(file).program(label);
    if (place) {
      place->file = file;
    }
    return place;
  };
  std::optional<Place> found;
  for (auto map = maps_.begin(); map != maps_.end() && !found; ++map) {
    found = in_file(map->first);
  }
  if (!found) {
    const auto file = files_.find(file_names(number));
    if (!file) {
      return refuse(
          line, label, "no_such_program",
          "no such subprogram in this file or in the subprogram folders; it is looked for as O" +
              label + " or O" + label + ".nc");
    }
    if (map_of(line, file->file) == nullptr) {
      return false;
    }
    // A file without an O number is the program as a whole.
    found = in_file(file->file);
    found = found ? found : file;
  }
  return enter_numbered(line, label, *found, repeats);
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
  const ProgramMap* const map = map_of(line, files_.line_end().file);
  std::optional<Place> place = map == nullptr ? std::nullopt : map->program(name);
  if (place) {
    place->file = files_.line_end().file;
  }
  return place;
}

// Nothing when it is refused or does not exist: see refused().
std::optional<Place> FlowControl::find_named(std::uint32_t line, const std::string& name) {
  refused_ = {};
  std::optional<Place> place = program_of_file(line, name);
  if (place || !refused_.reason.empty()) {
    return place;
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
  place = files_.find(names);
  if (!place) {
    refuse(line, name, "no_such_program",
           "an unknown word, and the subprogram folders have no NAME.SPF or NAME.MPF");
    refused_.word = name;
  }
  return place;
}

bool FlowControl::call_named(std::uint32_t line, const read::Flow& call) {
  const std::string name{call.label.view()};
  if (frames_.size() > kDeepestCall) {
    return refuse(line, name, "calls_too_deep", "subprogram calls nested more than ten deep");
  }
  values_ = call;
  const auto place = find_named(line, name);
  return place && enter_numbered(line, name, *place, values_.repeats);
}

// The program of a name must exist at once, not only at the first block that moves.
bool FlowControl::set_modal(std::uint32_t line, const read::Flow& call) {
  const std::string name{call.label.view()};
  modal_ = call;
  modal_.kind = name.empty() ? read::FlowKind::none : read::FlowKind::call;
  return name.empty() || read::is_digit(name.front()) || find_named(line, name);
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

// Its own moves do not call it again.
bool FlowControl::call_modal(std::uint32_t line) {
  const bool numbered = read::is_digit(modal_.label.view().front());
  const auto number = [&] { return std::stoi(std::string{modal_.label.view()}); };
  values_ = modal_;
  if (!(numbered ? call_numbered(line, number(), modal_.repeats) : call_named(line, modal_))) {
    return false;
  }
  frames_.back().modal = modal_running_ = true;
  return true;
}

}  // namespace steadyrest::nc::interpret
