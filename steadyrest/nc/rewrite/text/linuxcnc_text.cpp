// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// LinuxCNC's corrections use G10 L20: it sets the active work offset so that the present position
// reads s more or less. s, the correction in force, and v, the offset it belongs to, are noted in
// the offset's slots for axes that the machine does not have (README, "After an abort"), so
// LinuxCNC saves them together with it.

// Axes in the order they get notes, then unused axes whose slots in the work offset hold them: s,
// v.
constexpr std::string_view kServed = "ZYXWVU";
constexpr std::string_view kNotes = "WVUCBA";
// LinuxCNC's numbered parameters: #5221 … for G54 (n = 1).
constexpr int kWorkOffset = 5201;      // + 20 · n + axis
constexpr int kRotationNumber = 5210;  // + 20 · n
constexpr int kG92 = 5211;             // + axis
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
/// #5220 is the number of the active system: one text works in all of them.
std::string in_force(int base) {
  return fmt::format("#[{}+20*#5220]", base);
}
/// Not 0 where G10 L20 would not set exactly this axis: in a work offset rotated about Z, and where
/// X is a diameter (LinuxCNC's #<_x> is always a radius). Empty for other axes.
std::string when_crooked(char letter) {
  const std::string turned = fmt::format("ABS[{}]", in_force(kRotationNumber));
  return letter == 'X' ? turned + "+#<_lathe_diameter_mode>" : letter == 'Y' ? turned : "";
}
// G92 counts too, since it shifts the same axis; #5210 is 1 while it is in force.
std::string offset_of(char letter) {
  return fmt::format("{}+#5210*#{}", in_force(kWorkOffset + axis_of(letter)),
                     kG92 + axis_of(letter));
}

}  // namespace

// Two slots per axis, in a fixed order of axes whatever the plan corrects: the head of any program
// finds the notes left by another.
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
    // The second slot of the pair: both are filled.
    if (slot++ == 2 * before + 1) {
      return note;
    }
  }
  return {};
}

bool names_note(const Way& way, std::string_view line) {
  // `#` and its digits, however spaced. A number beyond all work offsets stops growing: it is not a
  // note and must not overflow.
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    int number = 0;
    for (const char c : line.substr(at + 1)) {
      if (c >= '0' && c <= '9' && number < kWorkOffset + 20 * (kWorkOffsets + 1)) {
        number = 10 * number + (c - '0');
      } else if (c != ' ' && c != '\t') {
        break;
      }
    }
    const auto is = [number](int first) {
      // The same slot in any of the nine systems.
      const int behind = number - first;
      return behind > 0 && behind <= 20 * kWorkOffsets && behind % 20 == 0;
    };
    const bool noted = std::ranges::any_of(kServed, [&](char letter) {
      const auto note =
          way.axes.find(letter) == std::string::npos ? std::nullopt : offset_note(way, letter);
      return note && (is(note->sum) || is(note->offset));
    });
    if (noted) {
      return true;
    }
  }
  return false;
}

// A program may be started from any line. So a line that builds on the previous one divides by 0
// unless that has just been executed.
// A division by 0 stops LinuxCNC at this line. `holds` is 1 where nothing is noted or v still
// matches the offset, otherwise 0.
std::string linuxcnc_check(const Way& way, char letter, std::string_view ending) {
  const OffsetNote note = offset_note(way, letter).value_or(OffsetNote{});
  const std::string holds = fmt::format("[{} EQ 0] OR [ABS[{}-{}] LT {}]", in_force(note.sum),
                                        offset_of(letter), in_force(note.offset), kSame);
  const std::string crooked = when_crooked(letter);
  const std::string all =
      crooked.empty() ? holds : fmt::format("[{}] AND [[{}] EQ 0]", holds, crooked);
  return fmt::format("#<_steadyrest_{}>=[1/[{}]] (STEADYREST {} check: divides by 0 if {}){}",
                     lower(letter), all, letter,
                     letter == 'X'   ? "set or turned since, or in G7"
                     : letter == 'Y' ? "set or turned since"
                                     : "the work offset was set since",
                     ending);
}

// Notes v again after the offset has changed; only directly after a check, whose 1 it divides by
// and then clears.
std::string linuxcnc_renote(const Way& way, char letter, std::string_view ending) {
  const OffsetNote note = offset_note(way, letter).value_or(OffsetNote{});
  return fmt::format(
      "{0}=[[{1}]/#<_steadyrest_{2}>] #<_steadyrest_{2}>=0 (STEADYREST {3} noted){4}",
      in_force(note.offset), offset_of(letter), lower(letter), letter, ending);
}

std::string linuxcnc_change(const Way& way, const Change& change, std::string_view ending) {
  const OffsetNote note = offset_note(way, change.letter).value_or(OffsetNote{});
  // #<_z> is the position shown: + s takes the noted correction off, − the new one puts it on. Both
  // are mm; kProgramUnits converts them to the unit in force.
  const std::string sum = in_force(note.sum);
  const std::string mark =
      fmt::format("(STEADYREST {}{} mm)", change.letter, correction_number(change.to_mm));
  const char axis = lower(change.letter);
  const std::string check = linuxcnc_check(way, change.letter, ending);
  // Off: no note remains, so the next head finds the offset as the operator left it.
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

/// For a program that corrects X and does not say G8.
std::string diameter_head(std::string_view ending) {
  const std::string mark = fmt::format(" (STEADYREST head X){}", ending);
  return "o<steadyrest_x3> if [#<_lathe_diameter_mode> NE 0]" + mark +
         fmt::format(
             "(ABORT,STEADYREST X is corrected, and G7 is in force: X would be a diameter. "
             "Give G8, then start again){}",
             ending) +
         "o<steadyrest_x3> endif" + mark;
}

std::string axis_head(const OffsetNote& note, char letter, std::string_view ending) {
  const char axis = lower(letter);
  const std::string sum = in_force(note.sum);
  const std::string noted = in_force(note.offset);
  const std::string crooked = when_crooked(letter);
  std::string all;
  std::string listed;
  // Written out for all nine systems; a sum of magnitudes is 0 only if every one is.
  for (int n = 1; n <= kWorkOffsets; ++n) {
    all += fmt::format("{}ABS[#{}]", n == 1 ? "" : "+", note.sum + 20 * n);
    listed += fmt::format(" #{}", note.sum + 20 * n);
  }
  const std::string mark = fmt::format(" (STEADYREST head {}){}", letter, ending);
  return fmt::format("#<_steadyrest_{}>=[{}]{}", axis, all, mark) +
         fmt::format("o<steadyrest_{0}1> if [#<_steadyrest_{0}> NE 0]{1}", axis, mark) +
         fmt::format(
             // Another system holds a note, or the offset was set since: only the operator can tell
             // how far the axis is off.
             "o<steadyrest_{0}2> if [[#<_steadyrest_{0}>-ABS[{1}] NE 0] OR [ABS[{2}-{3}] GE "
             "{4}]{5}]{6}",
             axis, sum, offset_of(letter), noted, kSame,
             crooked.empty() ? "" : fmt::format(" OR [{} NE 0]", crooked), mark) +
         // LinuxCNC shows 255 characters: what to do comes first.
         fmt::format(
             "(ABORT,STEADYREST after an aborted run {0} was set{1} or another offset chosen. Undo "
             "that, or touch off {0} and set parameter {2} for G54, {3} for G55, ... to 0. "
             "Left, mm:{4}){5}",
             letter,
             letter == 'X'   ? " or turned, G7 given,"
             : letter == 'Y' ? " or turned,"
                             : "",
             note.sum + 20, note.sum + 40, listed, ending) +
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

std::string linuxcnc_head(const Way& way, std::string_view letters, std::string_view ending) {
  const auto has = [&way](char axis) { return way.axes.find(axis) != std::string::npos; };
  std::string head;
  for (const char letter : kServed) {
    const auto note = has(letter) ? offset_note(way, letter) : std::nullopt;
    if (note) {
      head += axis_head(*note, letter, ending);
    }
  }
  const bool unsaid = has('Y') && letters.find('X') != std::string_view::npos;
  return unsaid ? head + diameter_head(ending) : head;
}

}  // namespace steadyrest::nc::rewrite
