// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <steadyrest/nc/interpret/flow/program_map.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::FlowKind;
using read::Landmark;
using read::Towards;

std::string in_capitals(std::string_view text) {
  std::string out{text};
  std::ranges::transform(out, out.begin(), read::upper);
  return out;
}

/// The digits of `N100`, `:100` or `100`; nothing for a name.
std::optional<std::uint32_t> block_number_of(std::string_view name) noexcept {
  const bool head = !name.empty() && (read::upper(name.front()) == 'N' || name.front() == ':');
  const std::string_view digits = name.substr(head ? 1 : 0);
  if (digits.empty() || digits.size() > 9 || !std::ranges::all_of(digits, read::is_digit)) {
    return std::nullopt;
  }
  std::uint32_t number = 0;
  for (const char c : digits) {
    number = number * 10 + static_cast<std::uint32_t>(c - '0');
  }
  return number;
}

bool begins(FlowKind kind) noexcept {
  return kind == FlowKind::when || kind == FlowKind::loop_while || kind == FlowKind::loop ||
         kind == FlowKind::loop_count || kind == FlowKind::loop_until;
}

bool ends(FlowKind end, FlowKind head) noexcept {
  return end == FlowKind::endif   ? head == FlowKind::when
         : end == FlowKind::until ? head == FlowKind::loop_until
                                  : head != FlowKind::when && head != FlowKind::loop_until;
}

}  // namespace

/// The pass over the file.
class ProgramMap::Noting {
 public:
  Noting(ProgramMap& map, read::Refused& refused) : map_(map), refused_(refused) {}

  bool line(const Landmark& mark, const Place& before, const Place& after, bool skipped) {
    if (mark.numbered) {
      map_.numbers_.emplace_back(mark.number, before);
    }
    if (!mark.label.empty()) {
      map_.labels_[in_capitals(mark.label)].push_back(before);
      ++labels_;
    }
    if (map_.numbers_.size() + labels_ + map_.marks_.size() + map_.exits_.size() > kMost) {
      return refuse(after.line, "too_many_labels",
                    "a program with jumps and more than a million block numbers, labels and "
                    "structures");
    }
    return skipped || kind(mark, before, after);
  }

  bool end() {
    return open_.empty() || refuse(map_.structures_[open_.back()].body.line, "structure_open",
                                   "a condition or loop without its end");
  }

 private:
  bool refuse(std::uint32_t line, std::string_view reason, std::string_view text) {
    refused_ = {.line = line, .word = {}, .reason = std::string{reason}, .text = std::string{text}};
    return false;
  }
  [[nodiscard]] std::size_t inside() const noexcept { return open_.empty() ? kNone : open_.back(); }

  bool kind(const Landmark& mark, const Place& before, const Place& after) {
    if (begins(mark.kind)) {
      return open(mark, before, after);
    }
    switch (mark.kind) {
      case FlowKind::otherwise:
        if (open_.empty() || map_.structures_[open_.back()].kind != FlowKind::when ||
            map_.structures_[open_.back()].otherwise.line != 0) {
          return refuse(after.line, "structure_unmatched", "ELSE without its IF");
        }
        map_.structures_[open_.back()].otherwise = after;
        map_.marks_.push_back({after.line, open_.back(), open_.back()});
        return true;
      case FlowKind::endif:
      case FlowKind::until:
      case FlowKind::end_loop:
        return close(mark, before, after);
      case FlowKind::label:
        return program(mark, before, after);
      case FlowKind::jump:
      case FlowKind::back:
      case FlowKind::modal_call:
      case FlowKind::section:
        map_.exits_.push_back({after.line, mark.kind, std::string{mark.target}, mark.towards});
        return true;
      default:
        return true;
    }
  }

  bool open(const Landmark& mark, const Place& before, const Place& after) {
    // fanuc: loops within each other have different numbers.
    const bool numbered = !mark.name.empty() && read::is_digit(mark.name.front());
    if (numbered && std::ranges::find(names_, mark.name) != names_.end()) {
      return refuse(after.line, "loop_number",
                    "a loop within another one of the same number; number them DO1 to DO3");
    }
    map_.marks_.push_back({after.line, map_.structures_.size(), map_.structures_.size()});
    const std::size_t parent = inside();
    open_.push_back(map_.structures_.size());
    names_.emplace_back(mark.name);
    map_.structures_.push_back({.kind = mark.kind,
                                .head = before,
                                .body = after,
                                .otherwise = {},
                                .foot = {},
                                .after = {},
                                .parent = parent});
    return true;
  }

  bool close(const Landmark& mark, const Place& before, const Place& after) {
    const bool numbered = !mark.name.empty() && read::is_digit(mark.name.front());
    if (open_.empty() || !ends(mark.kind, map_.structures_[open_.back()].kind) ||
        (!numbered && names_.back() != mark.name)) {
      return refuse(after.line, "structure_unmatched",
                    "the end of a condition or loop that does not begin before it");
    }
    if (names_.back() != mark.name) {
      return refuse(after.line, "loop_number",
                    "END with another number than its DO: loops must not overlap");
    }
    Structure& structure = map_.structures_[open_.back()];
    structure.foot = before;
    structure.after = after;
    const std::size_t index = open_.back();
    open_.pop_back();
    names_.pop_back();
    map_.marks_.push_back({after.line, index, inside()});
    return true;
  }

  bool program(const Landmark& mark, const Place& before, const Place& after) {
    if (!end()) {
      return false;
    }
    map_.programs_.push_back(before);
    // Of two programs with the same name the first counts.
    std::string name = in_capitals(mark.name);
    name.erase(0, std::min(name.find_first_not_of('0'), name.size() - 1));
    map_.program_names_.try_emplace(std::move(name), after);
    return true;
  }

  ProgramMap& map_;
  read::Refused& refused_;
  std::vector<std::size_t> open_;
  std::vector<std::string> names_;  ///< of the loops that are open
  std::size_t labels_ = 0;
};

bool ProgramMap::note(ProgramFiles& files, const read::Reader& reader, bool block_delete,
                      read::Refused& refused) {
  Noting noting(*this, refused);
  bool first = true;
  while (files.next() == read::LineSource::Status::line) {
    const std::string_view text = files.now().line();
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) {
      continue;
    }
    // The first line's % opens the file, a later one closes it.
    if (text[begin] == '%' &&
        text.find_first_not_of(" \t\r", begin + 1) == std::string_view::npos) {
      if (!first) {
        break;
      }
      first = false;
      continue;
    }
    first = false;
    const Landmark mark = reader.landmark(text);
    if (!noting.line(mark, files.line_begin(), files.line_end(), mark.deleted && block_delete)) {
      return false;
    }
  }
  std::ranges::stable_sort(numbers_, {}, &std::pair<std::uint32_t, Place>::first);
  note_repeats();
  return noting.end();
}

void ProgramMap::note_repeats() {
  std::vector<Lines> all;
  for (const Exit& exit : exits_) {
    if (exit.kind == FlowKind::modal_call) {
      continue;
    }
    const Lines program = extent(exit.line);
    const bool section = exit.kind == FlowKind::section;
    const Target target = find(exit.target, exit.line, section ? Towards::beginning : exit.towards);
    if (exit.kind != FlowKind::back && exit.towards == Towards::start) {
      all.emplace_back(program.first, exit.line);
    } else if (exit.kind == FlowKind::back ||  // perhaps M99 P
               target.found != Target::Found::yes) {
      all.push_back(program);
    } else if (target.place.line < exit.line) {
      all.emplace_back(target.place.line + 1, exit.line);
    }
  }
  std::ranges::sort(all);
  for (const Lines& lines : all) {
    if (!repeats_.empty() && lines.first <= repeats_.back().second) {
      repeats_.back().second = std::max(repeats_.back().second, lines.second);
    } else {
      repeats_.push_back(lines);
    }
  }
}

bool ProgramMap::may_repeat(std::uint32_t line) const noexcept {
  const auto next = std::ranges::upper_bound(repeats_, line, {}, &Lines::first);
  return next != repeats_.begin() && (next - 1)->second >= line;
}

std::size_t ProgramMap::at(std::uint32_t line) const noexcept {
  const auto found = std::ranges::lower_bound(marks_, line, {}, &Mark::line);
  return found != marks_.end() && found->line == line ? found->structure : kNone;
}

std::size_t ProgramMap::around(std::uint32_t line) const noexcept {
  // The last mark before the line says what is open in it.
  const auto found = std::ranges::lower_bound(marks_, line, {}, &Mark::line);
  return found == marks_.begin() ? kNone : (found - 1)->inside;
}

// First and last line of the program that contains the line.
ProgramMap::Lines ProgramMap::extent(std::uint32_t line) const noexcept {
  const auto next = std::ranges::upper_bound(programs_, line, {},
                                             [](const Place& place) { return place.line + 1; });
  return {next == programs_.begin() ? 1 : (next - 1)->line + 1,
          next == programs_.end() ? kToItsEnd : next->line};
}

Place ProgramMap::start_of_program(std::uint32_t line) const noexcept {
  const auto next = std::ranges::upper_bound(programs_, line, {},
                                             [](const Place& place) { return place.line + 1; });
  return next == programs_.begin() ? Place{} : *(next - 1);
}

std::optional<Place> ProgramMap::program(std::string_view name) const {
  const auto found = program_names_.find(in_capitals(name));
  return found == program_names_.end() ? std::nullopt : std::optional{found->second};
}

ProgramMap::Target ProgramMap::find(std::string_view name, std::uint32_t from,
                                    Towards towards) const {
  const auto [first, last] = extent(from);
  std::optional<Place> before;
  std::optional<Place> behind;
  std::size_t count_before = 0;
  std::size_t count_behind = 0;
  // In the order of the file: the last of those before the jump is the nearest.
  const auto take = [&](const Place& place) {
    const std::uint32_t line = place.line + 1;
    if (line < first || line > last) {
      return;
    }
    if (line <= from) {
      before = place;
      ++count_before;
    } else {
      behind = behind ? behind : place;
      ++count_behind;
    }
  };
  if (const auto number = block_number_of(name)) {
    const auto [begin, end] =
        std::ranges::equal_range(numbers_, *number, {}, &std::pair<std::uint32_t, Place>::first);
    std::for_each(begin, end, [&](const auto& one) { take(one.second); });
  } else if (const auto found = labels_.find(in_capitals(name)); found != labels_.end()) {
    std::ranges::for_each(found->second, take);
  }
  const bool forwards = towards != Towards::beginning;
  const bool backwards = towards != Towards::end;
  const std::size_t count = (forwards ? count_behind : 0) + (backwards ? count_before : 0);
  if (count == 0) {
    return {};
  }
  if (count > 1 && towards == Towards::anywhere) {
    return {.found = Target::Found::twice, .place = {}};
  }
  return {.found = Target::Found::yes, .place = forwards && behind ? *behind : *before};
}

std::uint32_t ProgramMap::end_of_doubt(std::uint32_t line, std::uint32_t to) const {
  // Exits are in the order of lines, so one pass suffices while the end moves on.
  auto exit = std::ranges::lower_bound(exits_, line, {}, &Exit::line);
  for (; exit != exits_.end() && exit->line < to; ++exit) {
    if (exit->target.empty() || exit->kind != FlowKind::jump) {
      return kToItsEnd;
    }
    const Target target = find(exit->target, exit->line, exit->towards);
    if (target.found != Target::Found::yes || target.place.line < exit->line) {
      return kToItsEnd;
    }
    to = std::max(to, target.place.line + 1);
  }
  return to;
}

}  // namespace steadyrest::nc::interpret
