// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

/// Marks every inserted line. Searched for in the whole line, in any dialect.
inline constexpr std::string_view kTag = "STEADYREST ";

/// The line was inserted: it holds a comment that begins with the tag, `(STEADYREST …)`,
/// `(ABORT,STEADYREST …)`, `(MSG,STEADYREST …)` or `;STEADYREST …`. compensate() refuses a program
/// whose author already wrote such a comment.
[[nodiscard]] bool is_inserted(std::string_view line) noexcept;

/// The inserted line belongs to the program's head (head_text): it acts only after an abort.
[[nodiscard]] bool is_head(std::string_view inserted_line) noexcept;

/// A SINUMERIK line names the R-parameter itself, or one by an unevaluated index: R[…], $R[…].
/// Comments do not count.
[[nodiscard]] bool uses_parameter(std::string_view line, std::uint32_t number) noexcept;

/// The prefix of the inserted lines' global parameters on linuxcnc.
inline constexpr std::string_view kOwnNames = "#<_steadyrest";
/// A LinuxCNC line names one of them, in any case and with any blanks.
[[nodiscard]] bool uses_own_names(std::string_view line) noexcept;

/// A SINUMERIK line names the frames' variables, or the setting data of the temperature
/// compensation. Comments do not count.
[[nodiscard]] bool names_variable(std::string_view line, std::string_view upper_begin) noexcept;

/// Writes `program` without its inserted lines to `output`, replaced lines put back (put_back.hpp),
/// all other bytes unchanged. Returns the number of lines removed. Refused with the line, and
/// nothing written: a line with the tag that compensate() does not write (WrittenLines), and the
/// tag in a program without a head.
[[nodiscard]] kernel::outcome::Result<std::size_t> strip(const std::string& program,
                                                         const std::string& output);

}  // namespace steadyrest::nc::rewrite
