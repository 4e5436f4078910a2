// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/stamp.hpp>

// Where a row's time comes from: a column of seconds, of stamps, of sample numbers, or the row
// number.
namespace steadyrest::table {
namespace {

constexpr std::int64_t kDay_s = 86'400;
constexpr int kExact = 12;

}  // namespace

StampReader::StampReader(const Head& head, std::size_t column)
    : column_(column), clocked_(head.stamped == column ? head.clocked : std::nullopt) {}

std::expected<Stamp, Fault> StampReader::read(const Row& row) {
  const std::string_view field = row.field(column_);
  const auto stamp =
      clocked_ ? stamp_of(field, row.field(*clocked_), order_) : stamp_of(field, order_);
  const std::string said = std::string(field) + (clocked_ ? " " : "") +
                           std::string(clocked_ ? row.field(*clocked_) : std::string_view());
  if (!stamp) {
    return std::unexpected(
        Fault{row.line(), fmt::format("\"{}\" is not a date and time", shown(said)),
              "write each stamp as in the first row, 2026-11-22T23:47:06.5; leave out "
              "the row of a leap second (:60)"});
  }
  if (stamp->ambiguous) {
    return std::unexpected(Fault{
        row.line(),
        fmt::format("\"{}\": the day or the month may come first, and no row before proves which",
                    shown(said)),
        "write the date as 2026-11-22 or 22.11.2026"});
  }
  order_ = order_ == DateOrder::unknown ? stamp->order : order_;
  return *stamp;
}

std::optional<std::size_t> time_column(const Head& head) {
  if (const auto own = head.place("t_s")) {
    return own;
  }
  const auto found = std::ranges::find_if(
      head.name, [](const std::string& name) { return time_factor(name).has_value(); });
  return found == head.name.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - head.name.begin()));
}

// The column with the name first, then a column of stamps, then sample numbers, then the rows
// themselves if the caller says that rows are samples.
std::optional<Clock> Clock::of(const Head& head, const Format& format, Epoch epoch) {
  Clock out;
  out.epoch_ = epoch;
  const auto own = time_column(head);
  out.column_ = own ? own : head.stamped ? head.stamped : head.epoch;
  if (out.column_ && out.column_ == head.stamped) {
    out.kind_ = Kind::stamp;
    out.stamps_.emplace(head, *out.column_);
    out.column_ = head.clocked ? head.clocked : out.column_;
    return out;
  }
  if (out.column_) {
    const bool since_1970 = out.column_ == head.epoch;
    out.kind_ = since_1970 ? Kind::epoch : Kind::number;
    out.factor_ =
        since_1970 ? head.epoch_factor : time_factor(head.name[*out.column_]).value_or(1.0);
    return out;
  }
  out.column_ = head.place("sample");
  out.factor_ = format.sample_hz > 0.0 ? 1.0 / format.sample_hz : 0.0;
  if (out.column_) {
    out.kind_ = Kind::sample;
    return out;
  }
  out.kind_ = Kind::rows;
  return format.rows_are_samples && out.factor_ > 0.0 ? std::optional(out) : std::nullopt;
}

std::expected<double, Fault> Clock::seconds(const Row& row) {
  switch (kind_) {
    case Kind::stamp:
      return stamped(row);
    case Kind::epoch:
      return since_1970(row);
    case Kind::rows:
      return factor_ * static_cast<double>(rows_++);
    case Kind::number:
    case Kind::sample:
      break;
  }
  // Sample numbers without a rate give no time.
  if (factor_ == 0.0) {
    return std::unexpected(Fault{row.line(), "the sample rate is unknown",
                                 "give --sample-hz, the samples per second"});
  }
  auto value = row.number(*column_);
  if (value) {
    *value *= factor_;
  }
  return value;
}

// In the file's unit up to midnight of the first day, so that a double keeps the digits.
std::expected<double, Fault> Clock::since_1970(const Row& row) {
  auto value = row.number(*column_);
  if (!value) {
    return value;
  }
  if (rows_++ == 0 && epoch_ == Epoch::first_day) {
    epoch_s_ = static_cast<std::int64_t>(*value * factor_) / kDay_s * kDay_s;
  }
  return (*value - std::round(static_cast<double>(epoch_s_) / factor_)) * factor_;
}

// All stamps with a zone or none: in a mixture, an hour's difference could mean either.
std::expected<double, Fault> Clock::stamped(const Row& row) {
  const auto stamp = stamps_->read(row);
  if (!stamp) {
    return std::unexpected(stamp.error());
  }
  decimals_ = stamp->decimals;
  if (rows_++ == 0) {
    zoned_ = stamp->zoned;
    // From midnight of the first day, so that seconds keep their digits in a double.
    epoch_s_ = epoch_ == Epoch::unix ? 0 : stamp->whole_s / kDay_s * kDay_s;
  } else if (zoned_ != stamp->zoned) {
    return std::unexpected(Fault{
        row.line(),
        fmt::format("the stamp \"{}\" {} time zone, the first row's {}", shown(row.field(*column_)),
                    stamp->zoned ? "has a" : "has no", zoned_ ? "does" : "does not"),
        "write every stamp with its time zone, or none"});
  }
  return static_cast<double>(stamp->whole_s - epoch_s_) + stamp->fraction_s;
}

int Clock::decimals(const Row& row) const {
  if (kind_ == Kind::number || kind_ == Kind::epoch) {
    // 5 ms has three decimals of a second; minutes are not decimal.
    const int of_unit = static_cast<int>(std::lround(-std::log10(factor_)));
    return factor_ > 1.0 ? kExact : decimals_of(row.field(*column_)) + of_unit;
  }
  return kind_ == Kind::stamp ? decimals_ : kExact;
}

}  // namespace steadyrest::table
