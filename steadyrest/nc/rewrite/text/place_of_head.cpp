// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>
#include <steadyrest/nc/rewrite/text/place_of_head.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// The head must run before anything acts, but after what the control requires at the top: %, a
// program number, definitions.
constexpr std::string_view kBlanks = " \t\r";

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}
constexpr char upper(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string_view trimmed(std::string_view line) noexcept {
  const std::size_t first = line.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

// A block number before a definition changes nothing.
std::string_view without_number(std::string_view line) noexcept {
  if (line.size() < 2 || upper(line[0]) != 'N' || !is_digit(line[1])) {
    return line;
  }
  const auto* const end = std::find_if_not(line.begin() + 1, line.end(), is_digit);
  return trimmed(line.substr(static_cast<std::size_t>(end - line.begin())));
}

/// Begins with this word, and the word ends there.
bool first_word(std::string_view line, std::string_view upper_word) noexcept {
  const bool same = line.size() >= upper_word.size() &&
                    std::ranges::equal(line.substr(0, upper_word.size()), upper_word, {}, upper);
  return same && (line.size() == upper_word.size() ||
                  kBlanks.find(line[upper_word.size()]) != std::string_view::npos);
}

}  // namespace

// A SINUMERIK requires definitions before the first block that does something (alarm 14500), a
// FANUC the program number first.
bool PlaceOfHead::opens(std::string_view line) const noexcept {
  if (line.empty() || line[0] == '%') {
    return true;
  }
  // O1234 or :1234; O-words of LinuxCNC never come here.
  if (way_.method == Method::fanuc || way_.method == Method::haas) {
    return line.size() > 1 && (upper(line[0]) == 'O' || line[0] == ':') && is_digit(line[1]);
  }
  if (!of_sinumerik(way_.method)) {
    return false;
  }
  const std::string_view block = without_number(line);
  constexpr std::array<std::string_view, 4> kDefinitions = {"DEF", "PROC", "EXTERN", "DEFINE"};
  return block.empty() || block[0] == ';' ||
         std::ranges::any_of(kDefinitions,
                             [block](std::string_view word) { return first_word(block, word); });
}

// The head goes before the first line that opens nothing; later ones are ignored.
void PlaceOfHead::look(std::string_view line, std::uint32_t number) noexcept {
  if (line_ == 0 && !opens(trimmed(line))) {
    line_ = number;
  }
}

// A program that writes to the same variable would undo corrections or be corrected by its own
// value: refused by its text alone, before anything is executed.
std::string own_use(const Way& way, std::string_view line) {
  constexpr std::string_view kSetting = "$SA_TEMP_COMP";
  constexpr std::string_view kFrames = "$P_";
  switch (way.method) {
    case Method::linuxcnc:
      return uses_own_names(line)    ? "uses the parameters of the corrections, #<_steadyrest…>"
             : names_note(way, line) ? "uses a parameter where a correction is noted: the work "
                                       "offset of an axis the machine does not have"
                                     : "";
    case Method::r_parameter:
      return uses_parameter(line, way.r_parameter)
                 ? fmt::format("may use R{} itself", way.r_parameter)
                 : std::string{};
    case Method::setting_data:
      return names_variable(line, kSetting) ? "uses the temperature compensation itself" : "";
    case Method::frame_fine:
      return names_variable(line, kFrames) ? "uses the frames' variables itself" : "";
    default:
      return {};
  }
}

std::string_view against_own_use(const Way& way) noexcept {
  return way.method == Method::linuxcnc      ? "use another parameter in the program"
         : way.method == Method::r_parameter ? "give the correction another R-parameter"
                                             : "choose another method for the corrections";
}

}  // namespace steadyrest::nc::rewrite
