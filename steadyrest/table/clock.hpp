// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string_view>

#include <steadyrest/table/row_reader.hpp>
#include <steadyrest/table/stamp.hpp>

namespace steadyrest::table {

/// Origin for stamps with a date.
enum class Epoch : std::uint8_t {
  unix,      ///< 1970-01-01, UTC or the clock's own zone: two logs can be compared
  first_day  ///< midnight before the first row: a double holds 0.01 ns
};

/// The stamps of a file's rows, in one column or two; the first that proves it decides whether the
/// day or the month comes first.
class StampReader {
 public:
  /// `column` has the stamps, or the dates of those whose times of day are in `head.clocked`.
  StampReader(const Head& head, std::size_t column);

  /// Once per row, in order.
  [[nodiscard]] std::expected<Stamp, Fault> read(const Row& row);

 private:
  std::size_t column_;
  std::optional<std::size_t> clocked_;
  DateOrder order_ = DateOrder::unknown;
};

/// The column that a header calls a time with its unit (time_factor()): t_s before all others.
[[nodiscard]] std::optional<std::size_t> time_column(const Head& head);

/// The time of a row, s: from a column of numbers, of stamps (stamp.hpp), of sample numbers, or
/// none.
class Clock {
 public:
  /// The column that is called a time (time_column()). If there is none: the only column of stamps;
  /// else of times since 1970; else a column `sample`; else rows at an even rate (Format). None of
  /// these: no clock.
  [[nodiscard]] static std::optional<Clock> of(const Head& head, const Format& format,
                                               Epoch epoch = Epoch::first_day);

  /// Once per row, in order.
  [[nodiscard]] std::expected<double, Fault> seconds(const Row& row);
  /// Decimals of a second in the row's written time; many where it is computed.
  [[nodiscard]] int decimals(const Row& row) const;
  /// The column, if there is one; of two, that of the time of day.
  [[nodiscard]] std::optional<std::size_t> column() const noexcept { return column_; }
  /// Whether the times are of a calendar.
  [[nodiscard]] bool dated() const noexcept { return kind_ == Kind::stamp || kind_ == Kind::epoch; }

 private:
  enum class Kind : std::uint8_t { number, stamp, epoch, sample, rows };

  [[nodiscard]] std::expected<double, Fault> stamped(const Row& row);
  [[nodiscard]] std::expected<double, Fault> since_1970(const Row& row);

  Kind kind_ = Kind::number;
  std::optional<std::size_t> column_;
  std::optional<StampReader> stamps_;
  int decimals_ = 0;  ///< of the last stamp
  double factor_ = 1.0;
  Epoch epoch_ = Epoch::first_day;
  std::size_t rows_ = 0;
  std::int64_t epoch_s_ = 0;
  bool zoned_ = false;
};

}  // namespace steadyrest::table
