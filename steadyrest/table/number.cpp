// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/core.h>

#include <steadyrest/table/number.hpp>

// A comma may be a decimal mark or group thousands. Numbers are read as they come, and the file is
// refused at its end if nothing in it has proved which: 12,5 does, 1,234 does not. A point in a
// file with commas is a contradiction.
namespace steadyrest::table {
namespace {

constexpr std::string_view kRepair = "repair the row or cut the log before it";

std::string_view without_plus(std::string_view field) noexcept {
  return field.size() > 1 && field[0] == '+' && field[1] != '-' ? field.substr(1) : field;
}

// Empty and unreadable are different: an empty field is a silent sensor.
Fault no_number(std::string_view name, std::string_view field, std::size_t line) {
  if (field.empty()) {
    return {line, fmt::format("{} is empty", name), std::string(kRepair)};
  }
  return {line, fmt::format("{} = \"{}\" is not a finite number", name, shown(field)),
          "write numbers without a unit; " + std::string(kRepair)};
}

/// Whether the comma of `field` may group digits: `1,234`, never `0,123`, `12,5` or `1234,567`.
bool could_group(std::string_view field) noexcept {
  const std::size_t sign = field.find_first_of("+-") == 0 ? 1 : 0;
  const std::size_t comma = field.find(',');
  const std::string_view behind = field.substr(comma + 1);
  const std::size_t before = comma - sign;
  const bool digits = std::ranges::all_of(behind, [](char c) { return c >= '0' && c <= '9'; });
  return behind.size() == 3 && digits && before >= 1 && before <= 3 && field[sign] != '0';
}

}  // namespace

// from_chars ignores the locale: a decimal comma in the user's settings changes nothing.
std::optional<double> plain_number(std::string_view field) noexcept {
  field = without_plus(field);
  double value = 0.0;
  const char* const begin = field.data();
  const char* const end = begin + field.size();
  const auto parsed = std::from_chars(begin, end, value);
  return parsed.ec == std::errc{} && parsed.ptr == end ? std::optional(value) : std::nullopt;
}

// Loose on purpose: it tells rows from heads, it does not read.
bool like_a_number(std::string_view field) noexcept {
  const bool digit = std::ranges::any_of(field, [](char c) { return c >= '0' && c <= '9'; });
  return digit && field.find_first_not_of("0123456789.,+-eE") == std::string_view::npos;
}

int decimals_of(std::string_view field) noexcept {
  const std::size_t e = field.find_first_of("eE");
  const std::string_view mantissa = field.substr(0, e);
  const std::size_t mark = mantissa.find_first_of(".,");
  int out = mark == std::string_view::npos ? 0 : static_cast<int>(mantissa.size() - mark - 1);
  // An exponent shifts the decimals: 1.5e-3 has four.
  if (e != std::string_view::npos) {
    int exponent = 0;
    const std::string_view text = without_plus(field.substr(e + 1));
    std::from_chars(text.data(), text.data() + text.size(), exponent);
    out -= std::clamp(exponent, -400, 400);
  }
  return std::max(out, 0);
}

// A point anywhere makes every comma a contradiction, before it or after it.
std::expected<double, Fault> NumberReader::read(std::string_view field, std::string_view name,
                                                std::size_t line) {
  const auto value = plain_number(field);
  if (!value) {
    return field.find(',') == std::string_view::npos ? std::unexpected(no_number(name, field, line))
                                                     : with_comma(field, name, line);
  }
  if (!std::isfinite(*value)) {
    return std::unexpected(no_number(name, field, line));
  }
  const bool may_have_point = point_line_ == 0 || comma_line_ != 0 || decimal_ == Decimal::comma;
  if (may_have_point && field.find('.') != std::string_view::npos) {
    point_line_ = point_line_ == 0 ? line : point_line_;
    if (comma_line_ != 0 || decimal_ == Decimal::comma) {
      return std::unexpected(Fault{
          line,
          comma_line_ == 0
              ? fmt::format("{} = \"{}\" has a point; --decimal comma is given", name, shown(field))
              : fmt::format("{} = \"{}\" has a point, line {} a comma", name, shown(field),
                            comma_line_),
          "use the same decimal mark throughout"});
    }
  }
  return *value;
}

std::expected<double, Fault> NumberReader::with_comma(std::string_view field, std::string_view name,
                                                      std::size_t line) {
  std::array<char, 64> text{};
  if (field.size() > text.size() || std::ranges::count(field, ',') > 1 ||
      field.find('.') != std::string_view::npos) {
    return std::unexpected(
        Fault{line, fmt::format("{} = \"{}\" is not a finite number", name, shown(field)),
              "write one decimal mark and no thousands separators"});
  }
  std::ranges::copy(field, text.begin());
  std::ranges::replace(std::span(text).first(field.size()), ',', '.');
  const auto value = plain_number(std::string_view(text.data(), field.size()));
  if (!value || !std::isfinite(*value)) {
    return std::unexpected(no_number(name, field, line));
  }
  if (decimal_ == Decimal::point || point_line_ != 0) {
    return std::unexpected(Fault{
        line,
        decimal_ == Decimal::point
            ? fmt::format("{} = \"{}\" has a comma; --decimal point is given", name, shown(field))
            : fmt::format("{} = \"{}\" has a comma, line {} a point", name, shown(field),
                          point_line_),
        "use the same decimal mark throughout, and no thousands separators"});
  }
  comma_line_ = comma_line_ == 0 ? line : comma_line_;
  // 1,234 may be either; one 12,5 in the file proves the comma a decimal mark.
  proved_ = proved_ || decimal_ == Decimal::comma || !could_group(field);
  return *value;
}

// Called once, at the end: any row may have held the proof.
std::optional<Fault> NumberReader::unproved() const {
  if (comma_line_ == 0 || proved_) {
    return std::nullopt;
  }
  return Fault{
      comma_line_,
      "the comma may be a decimal mark or a thousands separator, here and throughout the file",
      "give --decimal comma, or export numbers with a decimal point"};
}

}  // namespace steadyrest::table
