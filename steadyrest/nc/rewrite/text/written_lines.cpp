// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/written_lines.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr char kNumber = '\1';
constexpr char kAxes = '\2';

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// Length of the number at `at`, including its sign; 0 where none begins. Digits after G, M or L
/// are not a number but the word's meaning: G1 is not G0.
std::size_t number_at(std::string_view line, std::size_t at) noexcept {
  constexpr std::string_view kCodes = "GML";
  // Also within a code: the 0 of L20.
  std::size_t word = at;
  while (word > 0 && (is_digit(line[word - 1]) || line[word - 1] == '.')) {
    --word;
  }
  if (word > 0 && kCodes.find(line[word - 1]) != std::string_view::npos) {
    return 0;
  }
  std::size_t end = at + (line[at] == '+' || line[at] == '-' ? 1U : 0U);
  if (end == line.size() || !is_digit(line[end])) {
    return 0;
  }
  while (end < line.size() && (is_digit(line[end]) || line[end] == '.')) {
    ++end;
  }
  return end - at;
}

std::string form_of(std::string_view line) {
  constexpr std::string_view kHead = "STEADYREST head ";
  std::string form;
  for (std::size_t at = 0; at < line.size();) {
    if (const std::size_t length = number_at(line, at); length > 0) {
      form += kNumber;
      at += length;
    } else if (line.substr(at).starts_with(kHead)) {
      form += kHead;
      at += kHead.size();
      // One comment names all axes of the plan, in the plan's order.
      const std::size_t first = at;
      while (at < line.size() && interpret::kAxisLetters.find(line[at]) != std::string_view::npos) {
        ++at;
      }
      form += at > first ? std::string(1, kAxes) : std::string{};
    } else {
      form += line[at++];
    }
  }
  return form;
}

/// The record of how the program was made: a comment and nothing else, so it does nothing.
bool is_told(std::string_view line) noexcept {
  constexpr std::string_view kTold = "STEADYREST head told --";
  if (line.starts_with(';')) {
    return line.substr(1).starts_with(kTold);
  }
  return line.starts_with('(') && line.substr(1).starts_with(kTold) &&
         line.find(')') == line.size() - 1;
}

/// All lines that one method writes for one axis. Signs belong to the numbers; 0 is written
/// shorter.
std::string all_of(const Way& way, char letter) {
  constexpr double kSome_mm = 0.25;
  std::string text = check_text(way, letter, "\n") + renote_text(way, letter, "\n");
  for (const double to_mm : {0.0, kSome_mm}) {
    for (const bool incremental : {false, true}) {
      const Change change{
          .letter = letter, .from_mm = -kSome_mm, .to_mm = to_mm, .incremental = incremental};
      text += change_text(way, change, "\n");
      text += restate_text(way.method, change, true, kSome_mm, "\n");
      if (way.method == Method::linuxcnc) {
        text += restate_text(way.method, change, false, kSome_mm, "\n");
      }
    }
  }
  return text;
}

}  // namespace

WrittenLines::WrittenLines() {
  constexpr Method kMethods[] = {Method::linuxcnc,    Method::fanuc,        Method::haas,
                                 Method::r_parameter, Method::setting_data, Method::frame_fine};
  for (const Method method : kMethods) {
    for (const char letter : interpret::kAxisLetters) {
      // LinuxCNC's head covers the axes of the machine: a machine with this one axis only, so it
      // has its note.
      Way way{.method = method, .axes = std::string(1, letter)};
      add(all_of(way, letter));
      for (const bool free : {false, true}) {
        for (const bool cleared : {false, true}) {
          way.external_offset_free = free;
          way.cleared_after_abort = cleared;
          add(head_text(way, way.axes, "\n"));
        }
      }
    }
  }
  add(head_text(Way{.axes = "XY"}, "X", "\n"));  // with what X alone needs on a mill
}

void WrittenLines::add(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    forms_.insert(form_of(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

bool WrittenLines::has(std::string_view line) const {
  const bool clean =
      line.find(kNumber) == std::string_view::npos && line.find(kAxes) == std::string_view::npos;
  return clean && (is_told(line) || forms_.contains(form_of(line)));
}

}  // namespace steadyrest::nc::rewrite
