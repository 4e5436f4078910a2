// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/table/row_reader.hpp>

/// Where the columns of a recording's text begin, and what they are called.
///
/// The head is the first of the first 200 lines that names a time (signal_names.hpp), has as many
/// fields as the row behind it, and has a number or a stamp there in the column of that time; it
/// may begin with # or %. Where the rate is given, no time is needed: then the head has no numbers,
/// and the row nothing else. Lines before it are what loggers write about themselves.
///
/// Without a head two columns of numbers are time and value; with the rate given all columns are
/// values. Anything else is left to table::RowReader.
namespace steadyrest::chatter::offline {

struct SignalLayout {
  std::size_t head_line = 0;         ///< lines before it are skipped; 0: none are
  std::string head;                  ///< in place of that line; empty: as it is
  std::vector<std::string> columns;  ///< for table::Format, where the reader cannot find them
  std::string time;                  ///< what to call the times, where the file does not
  std::vector<std::string> notes;
};

/// Refused: rows of one column, or of three or more, with neither head nor rate.
[[nodiscard]] OrFault<SignalLayout> layout_of(std::string_view text, const table::Format& format);

/// Fields that stand for a missing value: empty, `nan`, `inf`, `null`, `n/a`, `-` and the like.
[[nodiscard]] bool is_gap(std::string_view field);

/// Whether a field is one number, with a decimal point or a comma.
[[nodiscard]] bool is_number(std::string_view field);

}  // namespace steadyrest::chatter::offline
