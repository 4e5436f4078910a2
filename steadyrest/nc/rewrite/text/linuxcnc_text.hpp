// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/nc/rewrite/text/writing.hpp>

/// How a program for LinuxCNC is corrected, and how it remembers its corrections.
///
/// A note is kept in the work offset it is about, in the numbers of axes that the machine does not
/// have: s, the correction in force (mm), and v, the axis' offset after it was written:
///
///     v = #[5203 + 20·n] + #5210 · #5213     (Z; n the work offset, in the units of the machine)
///
/// LinuxCNC keeps both in the variable file with the offset itself, so all three survive an abort,
/// a restart and a power cut together. As long as the offset is v, it contains s. If it is anything
/// else, somebody has set it since, and only the operator knows what it means.
namespace steadyrest::nc::rewrite {

/// Numbers of the parameters, to which 20 · n is added.
struct OffsetNote {
  int sum = 0;     ///< s
  int offset = 0;  ///< v
};
/// None where the machine has too many axes: each note needs two that it lacks. Z comes first, then
/// Y, X, W, V, U.
[[nodiscard]] std::optional<OffsetNote> offset_note(const Way& way, char letter);

/// The line names a parameter that may hold a note of one of the machine's axes: `#5229`.
[[nodiscard]] bool names_note(const Way& way, std::string_view line);

/// Stops when there is an s and the offset is not v; for X and Y also in a rotated offset, for X
/// also in diameter mode.
[[nodiscard]] std::string linuxcnc_check(const Way& way, char letter, std::string_view ending);
/// Checks; changes the correction from s, whatever it is, to `to_mm`; notes.
[[nodiscard]] std::string linuxcnc_change(const Way& way, const Change& change,
                                          std::string_view ending);
/// Notes v after a check and a line that has set the offset.
[[nodiscard]] std::string linuxcnc_renote(const Way& way, char letter, std::string_view ending);
/// For every axis that may have a note: takes off the correction left by an aborted run, or stops.
/// `letters`: the axes that the program corrects.
[[nodiscard]] std::string linuxcnc_head(const Way& way, std::string_view letters,
                                        std::string_view ending);

}  // namespace steadyrest::nc::rewrite
