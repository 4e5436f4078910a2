// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/step.hpp>
#include <steadyrest/nc/rewrite/linuxcnc_text.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr std::string_view kServed = "ZYXWVU";
constexpr std::string_view kNotes = "WVUCBA";
constexpr int kWorkOffset = 5201;  // + 20 · n + axis
constexpr int kG92 = 5211;         // + axis
constexpr int kWorkOffsets = 9;
// The variable file keeps six digits; mm or inches, as the machine has them.
constexpr std::string_view kSame = "0.000002";
// mm in the text, whatever G20 and G21 say.
constexpr std::string_view kProgramUnits = "[#<_metric>+#<_imperial>/25.4]";

int axis_of(char letter) {
  return static_cast<int>(interpret::kAxisLetters.find(letter));
}
char lower(char letter) noexcept {
  return static_cast<char>(letter - 'A' + 'a');
}

/// The parameter of the work offset in force.
std::string in_force(int base) {
  return fmt::format("#[{}+20*#5220]", base);
}
std::string offset_of(char letter) {
  return fmt::format("{}+#5210*#{}", in_force(kWorkOffset + axis_of(letter)),
                     kG92 + axis_of(letter));
}

}  // namespace

std::optional<OffsetNote> offset_note(const Way& way, char letter) {
  const auto has = [&](char axis) { return way.axes.find(axis) != std::string::npos; };
  std::size_t before = 0;
  for (const char served : kServed) {
    if (served == letter) {
      break;
    }
    before += has(served) ? 1U : 0U;
  }
  OffsetNote note;
  std::size_t slot = 0;
  for (const char free : kNotes) {
    if (has(free)) {
      continue;
    }
    (slot % 2 == 0 ? note.sum : note.offset) = kWorkOffset + axis_of(free);
    if (slot++ == 2 * before + 1) {
      return note;
    }
  }
  return {};
}

// Who starts a program from a line may start it at any. So a line that builds on the one before
// divides by 0 where that has not been executed just now.
std::string linuxcnc_check(const Way& way, char letter, std::string_view ending) {
  const OffsetNote note = offset_note(way, letter).value_or(OffsetNote{});
  return fmt::format(
      "#<_steadyrest_{}>=[1/[[{} EQ 0] OR [ABS[{}-{}] LT {}]]] (STEADYREST {} check: divides by 0 "
      "if the work offset was set since){}",
      lower(letter), in_force(note.sum), offset_of(letter), in_force(note.offset), kSame, letter,
      ending);
}

std::string linuxcnc_renote(const Way& way, char letter, std::string_view ending) {
  const OffsetNote note = offset_note(way, letter).value_or(OffsetNote{});
  return fmt::format(
      "{0}=[[{1}]/#<_steadyrest_{2}>] #<_steadyrest_{2}>=0 (STEADYREST {3} noted){4}",
      in_force(note.offset), offset_of(letter), lower(letter), letter, ending);
}

std::string linuxcnc_change(const Way& way, const Change& change, std::string_view ending) {
  const OffsetNote note = offset_note(way, change.letter).value_or(OffsetNote{});
  const std::string sum = in_force(note.sum);
  const std::string mark =
      fmt::format("(STEADYREST {}{} mm)", change.letter, correction_number(change.to_mm));
  const char axis = lower(change.letter);
  const std::string check = linuxcnc_check(way, change.letter, ending);
  if (change.to_mm == 0.0) {
    return check + fmt::format(
                       "G10 L20 P0 {0}[#<_{1}>+{2}*{3}/#<_steadyrest_{1}>] {2}=0 {4}=0 "
                       "#<_steadyrest_{1}>=0 {5}{6}",
                       change.letter, axis, sum, kProgramUnits, in_force(note.offset), mark,
                       ending);
  }
  return check +
         fmt::format("G10 L20 P0 {0}[#<_{1}>+[{2}{3}{4}]*{5}/#<_steadyrest_{1}>] {2}={6} {7}{8}",
                     change.letter, axis, sum, change.to_mm < 0.0 ? '+' : '-',
                     correction_number(std::abs(change.to_mm)), kProgramUnits,
                     correction_number(change.to_mm), mark, ending) +
         linuxcnc_renote(way, change.letter, ending);
}

namespace {

std::string axis_head(const OffsetNote& note, char letter, std::string_view ending) {
  const char axis = lower(letter);
  const std::string sum = in_force(note.sum);
  const std::string noted = in_force(note.offset);
  std::string all;
  std::string listed;
  for (int n = 1; n <= kWorkOffsets; ++n) {
    all += fmt::format("{}ABS[#{}]", n == 1 ? "" : "+", note.sum + 20 * n);
    listed += fmt::format(" #{}", note.sum + 20 * n);
  }
  const std::string mark = fmt::format(" (STEADYREST head {}){}", letter, ending);
  return fmt::format("#<_steadyrest_{}>=[{}]{}", axis, all, mark) +
         fmt::format("o<steadyrest_{0}1> if [#<_steadyrest_{0}> NE 0]{1}", axis, mark) +
         fmt::format(
             "o<steadyrest_{0}2> if [[#<_steadyrest_{0}>-ABS[{1}] NE 0] OR [ABS[{2}-{3}] GE "
             "{4}]]{5}",
             axis, sum, offset_of(letter), noted, kSame, mark) +
         fmt::format(
             "(ABORT,STEADYREST an aborted run corrected {0} in G54..G59.3 by{1} mm; since "
             "then {0} was set or another offset chosen. Touch off {0} there, then set "
             "parameter {2} for G54, {3} for G55, ... to 0){4}",
             letter, listed, note.sum + 20, note.sum + 40, ending) +
         fmt::format("o<steadyrest_{}2> endif{}", axis, mark) +
         fmt::format(
             "(MSG,STEADYREST an aborted run has left a correction in {0}. Cycle start takes it "
             "off. If {0} or a tool was touched off since: stop, touch off again){1}",
             letter, ending) +
         "M0" + mark +
         fmt::format("G10 L20 P0 {0}[#<_{1}>+{2}*{3}] {2}=0 {4}=0 #<_steadyrest_{1}>=0{5}", letter,
                     axis, sum, kProgramUnits, noted, mark) +
         fmt::format("o<steadyrest_{}1> endif{}", axis, mark);
}

}  // namespace

std::string linuxcnc_head(const Way& way, std::string_view ending) {
  std::string head;
  for (const char letter : kServed) {
    if (way.axes.find(letter) == std::string::npos) {
      continue;
    }
    if (const auto note = offset_note(way, letter)) {
      head += axis_head(*note, letter, ending);
    }
  }
  return head;
}

}  // namespace steadyrest::nc::rewrite
