// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

#include <steadyrest/table/text.hpp>

namespace steadyrest::table {

/// The mark before the decimals of a file's numbers.
enum class Decimal : std::uint8_t {
  by_file,  ///< the file decides
  point,
  comma
};

/// Reads the numbers of one file, all with the same decimal mark.
///
/// `1,234` may be 1.234 or a grouped 1234. A comma is the whole file's decimal mark as soon as one
/// of its numbers cannot be grouped (`0,5`, `12,5`, `1,2345`); where all of them could be,
/// unproved() refuses the file. A point never groups digits: no logger writes that. A file with
/// both marks is refused.
class NumberReader {
 public:
  explicit NumberReader(Decimal decimal = Decimal::by_file) noexcept : decimal_(decimal) {}

  /// A finite number. `name` is the column's, for the refusal.
  [[nodiscard]] std::expected<double, Fault> read(std::string_view field, std::string_view name,
                                                  std::size_t line);

  /// The refusal of a file in which every comma could group digits.
  [[nodiscard]] std::optional<Fault> unproved() const;

 private:
  [[nodiscard]] std::expected<double, Fault> with_comma(std::string_view field,
                                                        std::string_view name, std::size_t line);

  Decimal decimal_;
  bool proved_ = false;         ///< a comma cannot have grouped digits
  std::size_t comma_line_ = 0;  ///< of the first number with a comma
  std::size_t point_line_ = 0;  ///< of the first number with a point
};

/// A number with a decimal point; empty if the field is something else. It may be infinite.
[[nodiscard]] std::optional<double> plain_number(std::string_view field) noexcept;

/// Whether a field could be a number in either notation.
[[nodiscard]] bool like_a_number(std::string_view field) noexcept;

/// Digits after the decimal mark, less the exponent.
[[nodiscard]] int decimals_of(std::string_view field) noexcept;

}  // namespace steadyrest::table
