// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include <steadyrest/table/stamp.hpp>

// ISO 8601, basic and extended, as recorders and spreadsheets write it. Parsed by hand: this
// compiler's library parsers allocate and depend on the locale.
namespace steadyrest::table {
namespace {

constexpr int kMostDecimals = 12;

/// Parses a text from the front.
class Cursor {
 public:
  explicit Cursor(std::string_view text) noexcept : rest_(text) {}

  [[nodiscard]] bool done() const noexcept { return rest_.empty(); }
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] bool at_digit() const noexcept {
    return !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9';
  }

  bool take(char c) noexcept {
    if (rest_.empty() || rest_.front() != c) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }

  /// A number of exactly `count` digits, at most `most`.
  int digits(int count, int most) noexcept {
    int out = 0;
    for (int i = 0; i < count; ++i) {
      if (!at_digit()) {
        ok_ = false;
        return 0;
      }
      out = 10 * out + (rest_.front() - '0');
      rest_.remove_prefix(1);
    }
    ok_ = ok_ && out <= most;
    return out;
  }

  /// The digits after a decimal mark, and their number. Twelve digits are more than a second's
  /// fraction needs in a double.
  double fraction(int& count) noexcept {
    double value = 0.0;
    double scale = 1.0;
    for (; at_digit(); rest_.remove_prefix(1)) {
      if (++count <= kMostDecimals) {
        value = 10.0 * value + (rest_.front() - '0');
        scale *= 10.0;
      }
    }
    ok_ = ok_ && count > 0;
    return value / scale;
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

/// Minutes ahead of UTC.
int zone_min(Cursor& at) noexcept {
  if (at.take('Z') || at.take('z')) {
    return 0;
  }
  const bool behind = at.take('-');
  if (!behind && !at.take('+')) {
    static_cast<void>(at.digits(1, -1));  // neither: a fault
    return 0;
  }
  int minutes = 60 * at.digits(2, 14);
  if (at.take(':') || at.at_digit()) {
    minutes += at.digits(2, 59);
  }
  return behind ? -minutes : minutes;
}

}  // namespace

std::optional<Stamp> stamp_of(std::string_view field) noexcept {
  Cursor at(field);
  const int year = at.digits(4, 2199);
  const bool dashes = at.take('-');
  const int month = at.digits(2, 12);
  // All separators or none: 2026-1122 is neither form.
  if (!at.ok() || dashes != at.take('-')) {
    return std::nullopt;
  }
  const int day = at.digits(2, 31);
  if (!at.ok() || (!at.take('T') && !at.take('t') && !at.take(' '))) {
    return std::nullopt;
  }
  const int hour = at.digits(2, 23);
  const bool colons = at.take(':');
  const int minute = at.digits(2, 59);
  Stamp out;
  int second = 0;
  if (colons ? at.take(':') : at.at_digit()) {
    second = at.digits(2, 59);  // a leap second is not in this count
    if (at.take('.') || at.take(',')) {
      out.fraction_s = at.fraction(out.decimals);
    }
  }
  int ahead_min = 0;
  if (!at.done()) {
    out.zoned = true;
    ahead_min = zone_min(at);
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  // There was no such log before 1970, and the count of seconds would be negative.
  if (!at.ok() || !at.done() || year < 1970 || !date.ok()) {
    return std::nullopt;
  }
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  // Whole seconds and fraction separately: one double since 1970 resolves 0.2 µs.
  out.whole_s = 86'400 * days + 3600LL * hour + 60LL * (minute - ahead_min) + second;
  return out;
}

}  // namespace steadyrest::table
