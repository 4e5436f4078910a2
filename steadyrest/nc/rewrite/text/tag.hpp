// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

/// By this every inserted line is found again. Looked for in the whole line, in any dialect.
inline constexpr std::string_view kTag = "STEADYREST ";

/// The line was inserted: it holds a comment that begins with the tag, `(STEADYREST …)`,
/// `(ABORT,STEADYREST …)`, `(MSG,STEADYREST …)` or `;STEADYREST …`. A program in which the author
/// wrote such a comment himself is refused by compensate().
[[nodiscard]] bool is_inserted(std::string_view line) noexcept;

/// The inserted line belongs to the program's head (head_text): it does something only after an
/// abort.
[[nodiscard]] bool is_head(std::string_view inserted_line) noexcept;

/// A SINUMERIK line names the R-parameter itself, or one by a value that is not looked at: R[…],
/// $R[…]. Comments do not count.
[[nodiscard]] bool uses_parameter(std::string_view line, std::uint32_t number) noexcept;

/// What the global parameters of inserted lines begin with, on linuxcnc.
inline constexpr std::string_view kOwnNames = "#<_steadyrest";
/// A LinuxCNC line names one of them, in whatever letters and with blanks.
[[nodiscard]] bool uses_own_names(std::string_view line) noexcept;

/// A SINUMERIK line names the frames' variables, or the setting data of the temperature
/// compensation. Comments do not count.
[[nodiscard]] bool names_variable(std::string_view line, std::string_view upper_begin) noexcept;

/// Writes `program` without its inserted lines to `output`, all other bytes as they are. Gives the
/// number of lines taken out. Refused with the line, and nothing written: a line that has the tag
/// but is none that compensate() writes (WrittenLines), and the tag in a program without a head.
[[nodiscard]] kernel::outcome::Result<std::size_t> strip(const std::string& program,
                                                         const std::string& output);

}  // namespace steadyrest::nc::rewrite
