// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>

/// The first lines of an encoder log: what kind of file it is, and where its columns are.
namespace steadyrest::motion::offline {

/// What is wrong, and the way out.
struct LogFault {
  std::string what;
  std::string to_do;
};

/// Where the fields stand in a row.
struct LogColumns {
  char separator = ',';
  std::size_t time = 0;
  std::size_t count = 1;
  std::size_t all = 2;
};

[[nodiscard]] std::string_view trimmed(std::string_view text);

/// At most 40 characters of a field, with nothing that a terminal would act on.
[[nodiscard]] std::string shown(std::string_view field);

/// A file that is no text, told by its first bytes; empty `what` when it may be text.
[[nodiscard]] LogFault fault_of_kind(std::string_view first_bytes);

[[nodiscard]] std::expected<LogColumns, LogFault> columns_of(std::string_view header);

}  // namespace steadyrest::motion::offline
