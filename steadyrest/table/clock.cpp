// SPDX-License-Identifier: Apache-2.0
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

// The caller's own column first, then a column of stamps, then sample numbers, then the rows
// themselves if the caller says that rows are samples.
std::optional<Clock> Clock::of(const Head& head, const Format& format,
                               std::optional<std::size_t> own, double factor, Epoch epoch) {
  Clock out;
  out.epoch_ = epoch;
  out.column_ = own ? own : head.stamped;
  if (out.column_) {
    out.kind_ = head.stamped == out.column_ ? Kind::stamp : Kind::number;
    out.factor_ = factor;
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

// All stamps with a zone or none: in a mixture, an hour's difference could mean either.
std::expected<double, Fault> Clock::stamped(const Row& row) {
  const std::string_view field = row.field(*column_);
  const auto stamp = stamp_of(field);
  if (!stamp) {
    return std::unexpected(
        Fault{row.line(), fmt::format("\"{}\" is not a date and time", shown(field)),
              "write each stamp as in the first row, 2026-11-22T23:47:06.5; leave out "
              "the row of a leap second (:60)"});
  }
  if (rows_++ == 0) {
    zoned_ = stamp->zoned;
    // From midnight of the first day, so that seconds keep their digits in a double.
    epoch_s_ = epoch_ == Epoch::unix ? 0 : stamp->whole_s / kDay_s * kDay_s;
  } else if (zoned_ != stamp->zoned) {
    return std::unexpected(
        Fault{row.line(),
              fmt::format("the stamp \"{}\" {} time zone, the first row's {}", shown(field),
                          stamp->zoned ? "has a" : "has no", zoned_ ? "does" : "does not"),
              "write every stamp with its time zone, or none"});
  }
  return static_cast<double>(stamp->whole_s - epoch_s_) + stamp->fraction_s;
}

int Clock::decimals(const Row& row) const {
  if (kind_ == Kind::number) {
    return decimals_of(row.field(*column_));
  }
  const auto stamp = kind_ == Kind::stamp ? stamp_of(row.field(*column_)) : std::nullopt;
  return stamp ? stamp->decimals : kExact;
}

}  // namespace steadyrest::table
