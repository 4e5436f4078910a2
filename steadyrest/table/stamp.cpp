// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <span>

#include <steadyrest/table/stamp.hpp>

// ISO 8601, basic and extended, and the other dates of recorders and spreadsheets. Parsed by hand:
// this compiler's library parsers allocate and depend on the locale.
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

  /// A number of one or two digits, at most `most`.
  int short_number(int most) noexcept {
    const bool two = rest_.size() >= 2 && rest_[1] >= '0' && rest_[1] <= '9';
    return digits(two ? 2 : 1, most);
  }
  /// How many digits are in front.
  [[nodiscard]] std::size_t digit_count() const noexcept {
    const std::size_t end = rest_.find_first_not_of("0123456789");
    return end == std::string_view::npos ? rest_.size() : end;
  }
  /// The character in front of which `count` more are.
  [[nodiscard]] char at(std::size_t count) const noexcept {
    return count < rest_.size() ? rest_[count] : '\0';
  }
  /// One of these words, in any case: its place, from 1; 0 for none.
  int word(std::span<const std::string_view> words) noexcept {
    for (std::size_t i = 0; i < words.size(); ++i) {
      const bool same =
          rest_.size() >= words[i].size() &&
          std::ranges::equal(words[i], rest_.substr(0, words[i].size()),
                             [](char a, char b) { return a == static_cast<char>(b | 0x20); });
      if (same) {
        rest_.remove_prefix(words[i].size());
        return static_cast<int>(i) + 1;
      }
    }
    return 0;
  }
  void fail() noexcept { ok_ = false; }

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
    at.fail();
    return 0;
  }
  int minutes = 60 * at.digits(2, 14);
  if (at.take(':') || at.at_digit()) {
    minutes += at.digits(2, 59);
  }
  return behind ? -minutes : minutes;
}

struct Date {
  int year = 0;
  int month = 0;
  int day = 0;
};

/// `2026-11-22`, `2026/11/22`, `20261122`: separators twice, or none.
Date year_first(Cursor& at) noexcept {
  Date out;
  out.year = at.digits(4, 2199);
  const char mark = at.at(0);
  const bool marked = mark == '-' || mark == '/' || mark == '.';
  if (marked) {
    at.take(mark);
  }
  const bool loose = mark == '/' || mark == '.';  // spreadsheets write 2026/1/5, ISO does not
  out.month = loose ? at.short_number(12) : at.digits(2, 12);
  if (marked && !at.take(mark)) {
    at.fail();
  }
  out.day = loose ? at.short_number(31) : at.digits(2, 31);
  return out;
}

/// `22-Nov-2026`, `22 Nov 26`.
Date with_name(Cursor& at) noexcept {
  constexpr std::array<std::string_view, 12> kMonths = {"jan", "feb", "mar", "apr", "may", "jun",
                                                        "jul", "aug", "sep", "oct", "nov", "dec"};
  constexpr int kCentury = 2000;
  Date out;
  out.day = at.short_number(31);
  const char mark = at.at(0);
  at.take(mark);
  out.month = at.word(kMonths);
  if (out.month == 0 || !at.take(mark)) {
    at.fail();
  }
  const bool whole = at.digit_count() == 4;
  out.year = whole ? at.digits(4, 2199) : kCentury + at.digits(2, 99);
  return out;
}

/// `22.11.2026`, `22/11/2026`, `11/22/2026`: a dot means day first; the others need a proof.
Date year_last(Cursor& at, DateOrder order, Stamp& to) noexcept {
  const int first = at.short_number(31);
  const char mark = at.at(0);
  at.take(mark);
  const int second = at.short_number(31);
  if (!at.take(mark)) {
    at.fail();
  }
  const int year = at.digits(4, 2199);
  const bool dotted = mark == '.';
  const bool proved = !dotted && (first > 12) != (second > 12);
  to.order = !proved      ? DateOrder::unknown
             : first > 12 ? DateOrder::day_first
                          : DateOrder::month_first;
  to.ambiguous = !dotted && !proved && first != second && order == DateOrder::unknown;
  const bool month_first = !dotted && (proved && order == DateOrder::unknown ? to.order : order) ==
                                          DateOrder::month_first;
  return month_first ? Date{year, first, second} : Date{year, second, first};
}

Date date_in(Cursor& at, DateOrder order, Stamp& to) noexcept {
  const std::size_t digits = at.digit_count();
  const char mark = at.at(digits);
  if (digits == 4 || digits == 8) {
    return year_first(at);
  }
  if (digits < 1 || digits > 2 || (mark != '.' && mark != '/' && mark != '-' && mark != ' ')) {
    at.fail();
    return {};
  }
  const bool named = at.at(digits + 1) > '9';
  if (!named && mark == ' ') {
    at.fail();
    return {};
  }
  return named ? with_name(at) : year_last(at, order, to);
}

/// AM or PM behind a time of 1 … 12 hours.
int hour_of(Cursor& at, int hour) noexcept {
  constexpr std::array<std::string_view, 2> kHalves = {"am", "pm"};
  while (at.take(' ')) {
  }
  const int half = at.word(kHalves);
  if (half == 0) {
    return hour;
  }
  if (hour < 1 || hour > 12) {
    at.fail();
  }
  return hour % 12 + (half == 2 ? 12 : 0);
}

/// From the hour to the zone, in seconds of the day, into the stamp.
std::int64_t time_in(Cursor& at, Stamp& to) noexcept {
  // One digit only before a colon: 8:00.
  int hour = at.at(1) == ':' ? at.digits(1, 9) : at.digits(2, 23);
  const bool colons = at.take(':');
  const int minute = at.digits(2, 59);
  int second = 0;
  if (colons ? at.take(':') : at.at_digit()) {
    second = at.digits(2, 59);  // a leap second is not in this count
    const bool mark = at.take('.') || at.take(',');
    // Some controls write milliseconds behind a colon.
    const bool colon = !mark && colons && at.take(':');
    if (colon && at.digit_count() != 3) {
      at.fail();
    }
    if (mark || colon) {
      to.fraction_s = at.fraction(to.decimals);
    }
  }
  hour = hour_of(at, hour);
  int ahead_min = 0;
  if (!at.done()) {
    to.zoned = true;
    ahead_min = zone_min(at);
  }
  return 3600LL * hour + 60LL * (minute - ahead_min) + second;
}

}  // namespace

std::optional<Stamp> stamp_of(std::string_view field, DateOrder order) noexcept {
  Cursor at(field);
  Stamp out;
  const Date date = date_in(at, order, out);
  if (!at.ok()) {
    return std::nullopt;
  }
  at.take(',');
  if (!at.take('T') && !at.take('t') && !at.take(' ')) {
    return std::nullopt;
  }
  while (at.take(' ')) {
  }
  const std::int64_t of_day_s = time_in(at, out);
  const std::chrono::year_month_day day{std::chrono::year(date.year),
                                        std::chrono::month(static_cast<unsigned>(date.month)),
                                        std::chrono::day(static_cast<unsigned>(date.day))};
  // There was no such log before 1970, and the count of seconds would be negative.
  if (!at.ok() || !at.done() || date.year < 1970 || !day.ok()) {
    return std::nullopt;
  }
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  // Whole seconds and fraction separately: one double since 1970 resolves 0.2 µs.
  out.whole_s = 86'400 * days + of_day_s;
  return out;
}

std::optional<Stamp> stamp_of(std::string_view date, std::string_view time,
                              DateOrder order) noexcept {
  std::array<char, 64> text{};
  if (date.size() + time.size() + 1 > text.size()) {
    return std::nullopt;
  }
  auto end = std::ranges::copy(date, text.begin()).out;
  *end++ = ' ';
  end = std::ranges::copy(time, end).out;
  return stamp_of(std::string_view(text.begin(), end), order);
}

// A number of eight digits is no date, and 1200 no time of day.
bool is_date(std::string_view field) noexcept {
  return field.find_first_not_of("0123456789") != std::string_view::npos &&
         stamp_of(field, "00:00", DateOrder::unknown).has_value();
}

bool is_time_of_day(std::string_view field) noexcept {
  return field.find(':') != std::string_view::npos &&
         stamp_of("2000-01-01", field, DateOrder::unknown).has_value();
}

}  // namespace steadyrest::table
