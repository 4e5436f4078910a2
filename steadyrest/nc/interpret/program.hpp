// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/config.hpp>
#include <steadyrest/nc/interpret/move.hpp>
#include <steadyrest/nc/read/line_source.hpp>
#include <steadyrest/nc/read/refused.hpp>

namespace steadyrest::nc::interpret {

/// What came of a program.
struct Report {
  std::uint64_t lines = 0;
  std::uint64_t blocks = 0;  ///< lines with at least one word that were executed
  std::uint64_t moves = 0;   ///< moves and dwells that the sink was given
  /// Empty when the program was executed to its end. The first entry is where the execution
  /// stopped; the others are words further down that the reader or the dialect's vocabulary does
  /// not accept, each kind once, at most `kMostRefused`.
  std::vector<read::Refused> refused;

  static constexpr std::size_t kMostRefused = 50;
};

/// Executes a whole program from a file, in bounded memory. An error is a file that cannot be
/// read; refused words stand in the report.
kernel::outcome::Result<Report> run_file(const std::string& path, const Config& config, Sink& sink);

/// The same for a text in memory.
kernel::outcome::Result<Report> run_text(std::string_view text, const Config& config, Sink& sink);

/// The same for any source of lines.
kernel::outcome::Result<Report> run_lines(read::LineSource& source, const Config& config,
                                          Sink& sink);

/// The first refusal of a report in the form that all rooms show: `FILE:LINE: what; to do`.
[[nodiscard]] kernel::outcome::Refusal first_refusal(const Report& report, const std::string& path);

}  // namespace steadyrest::nc::interpret
