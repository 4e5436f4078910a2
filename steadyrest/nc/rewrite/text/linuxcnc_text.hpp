// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/nc/rewrite/text/writing.hpp>

/// How a program for LinuxCNC is corrected, and how it remembers what it has done.
///
/// A note lies in the work offset that it is about, in the numbers of axes that the machine does
/// not have: s, the correction that stands (mm), and v, what the axis' offset was after it was
/// written:
///
///     v = #[5203 + 20·n] + #5210 · #5213     (Z; n the work offset, in the units of the machine)
///
/// LinuxCNC keeps both in the variable file beside the offset itself, so an abort, a restart and a
/// power cut leave the three as they belong together. As long as the offset is v, s is in it. When
/// it is anything else somebody has set it since, and nobody but the operator knows what it means.
namespace steadyrest::nc::rewrite {

/// Numbers of the parameters, to which 20 · n is added.
struct OffsetNote {
  int sum = 0;     ///< s
  int offset = 0;  ///< v
};
/// None where the machine has too many axes: each needs two that it has not. Z is served first,
/// then Y, X, W, V, U.
[[nodiscard]] std::optional<OffsetNote> offset_note(const Way& way, char letter);

/// The line names a parameter that may hold a note of one of the machine's axes: `#5229`.
[[nodiscard]] bool names_note(const Way& way, std::string_view line);

/// Stops when there is an s, and the offset is not v; in X and Y also where they are turned, in X
/// where it is a diameter.
[[nodiscard]] std::string linuxcnc_check(const Way& way, char letter, std::string_view ending);
/// Checks; corrects from s, whatever it is, to `to_mm`; notes.
[[nodiscard]] std::string linuxcnc_change(const Way& way, const Change& change,
                                          std::string_view ending);
/// v, behind a check and a line that has set the offset.
[[nodiscard]] std::string linuxcnc_renote(const Way& way, char letter, std::string_view ending);
/// For every axis that may have a note: takes off what an aborted run has left, or stops.
/// `letters`: the axes that the program corrects.
[[nodiscard]] std::string linuxcnc_head(const Way& way, std::string_view letters,
                                        std::string_view ending);

}  // namespace steadyrest::nc::rewrite
