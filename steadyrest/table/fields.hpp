// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

/// A line of a log as its fields.
namespace steadyrest::table {

/// Without blanks and quotes around.
[[nodiscard]] std::string_view field_of(std::string_view text);

/// By `,`, `;` or tab outside quotes; by ' ' at any number of blanks and tabs.
void split_fields(std::string_view text, char separator, std::vector<std::string_view>& fields);

/// Whether a field could be a number or a stamp: a row has one at least, a head none.
[[nodiscard]] bool holds_value(std::string_view field);

/// The first mark of the head that splits head and first row alike, else the first one, else a
/// comma.
[[nodiscard]] char separator_of(std::string_view head, std::string_view row);

}  // namespace steadyrest::table
