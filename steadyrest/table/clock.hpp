// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::table {

/// Origin for stamps with a date.
enum class Epoch : std::uint8_t {
  unix,      ///< 1970-01-01, UTC or the clock's own zone: two logs can be compared
  first_day  ///< midnight before the first row: a double holds 0.01 ns
};

/// The time of a row, s: from a column of numbers, of stamps (ISO 8601), of sample numbers, or
/// none.
class Clock {
 public:
  /// `own` is the column that the verb calls its time, in units of `factor` seconds. If there is
  /// none: the only column of stamps; else a column `sample`; else rows at an even rate (Format).
  /// None of these: no clock.
  [[nodiscard]] static std::optional<Clock> of(const Head& head, const Format& format,
                                               std::optional<std::size_t> own, double factor = 1.0,
                                               Epoch epoch = Epoch::first_day);

  /// Once per row, in order.
  [[nodiscard]] std::expected<double, Fault> seconds(const Row& row);
  /// Decimals of a second in the row's written time; many where it is computed.
  [[nodiscard]] int decimals(const Row& row) const;
  /// The column, if there is one.
  [[nodiscard]] std::optional<std::size_t> column() const noexcept { return column_; }

 private:
  enum class Kind : std::uint8_t { number, stamp, sample, rows };

  [[nodiscard]] std::expected<double, Fault> stamped(const Row& row);

  Kind kind_ = Kind::number;
  std::optional<std::size_t> column_;
  double factor_ = 1.0;
  Epoch epoch_ = Epoch::first_day;
  std::size_t rows_ = 0;
  std::int64_t epoch_s_ = 0;
  bool zoned_ = false;
};

}  // namespace steadyrest::table
