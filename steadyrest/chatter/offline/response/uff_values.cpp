// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff_values.hpp>

// At each point: the abscissa (uneven only), then one number or, complex, two. In text the numbers
// are counted, not the lines, which hold more or fewer by number type. In bytes an abscissa has
// four or eight of them beside doubles: writers differ, so the size that ends at the −1 is right.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr std::size_t kMostValues = 10'000'000;

bool doubles(int number_type) {
  return number_type == 4 || number_type == 6;
}
std::size_t parts_of(int number_type) {
  return number_type >= 5 ? 2 : 1;
}

double number_at(std::string_view bytes, std::size_t at, std::size_t size, UffForm::Bytes order) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = order == UffForm::Bytes::big_endian ? i : size - 1 - i;
    word = (word << 8U) | static_cast<unsigned char>(bytes[at + from]);
  }
  return size == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)))
                   : std::bit_cast<double>(word);
}

void put(const UffShape& shape, UffFunction& out, double at, double real, double imaginary) {
  out.at.push_back(shape.even ? shape.first + static_cast<double>(out.at.size()) * shape.step : at);
  out.value.emplace_back(real, imaginary);
}

std::optional<Refusal> from_bytes(const UffForm& form, const UffShape& shape, UffLines& lines,
                                  UffFunction& out) {
  const std::size_t size = doubles(shape.number_type) ? 8 : 4;
  const std::size_t parts = parts_of(shape.number_type);
  std::size_t before = 0;  // bytes of the abscissa
  if (!shape.even) {
    before = size == 8 && lines.ends_after(shape.count * (4 + size * parts)) ? 4 : size;
  }
  const std::size_t point = before + size * parts;
  const std::size_t whole = shape.count * point;
  if (whole > lines.left() || !lines.ends_after(whole)) {
    return lines.bad(
        fmt::format("{} points of {} bytes do not end at a −1; {} bytes are announced, "
                    "{} follow",
                    shape.count, point, form.announced, lines.left()),
        "the file is truncated or was transferred as text; copy it as binary, or "
        "export it again");
  }
  const std::string_view bytes = lines.bytes(whole);
  for (std::size_t at = 0; at < whole; at += point) {
    std::array<double, 3> value{};
    value[0] = before == 0 ? 0.0 : number_at(bytes, at, before, form.bytes);
    for (std::size_t i = 0; i < parts; ++i) {
      value[1 + i] = number_at(bytes, at + before + i * size, size, form.bytes);
    }
    if (!std::ranges::all_of(value, [](double v) { return std::isfinite(v); })) {
      return lines.bad(fmt::format("point {} is not a finite number", at / point + 1),
                       "export the response again");
    }
    put(shape, out, value[0], value[1], value[2]);
  }
  return std::nullopt;
}

std::optional<Refusal> from_text(const UffShape& shape, UffLines& lines, UffFunction& out) {
  const std::size_t before = shape.even ? 0 : 1;
  const std::size_t per_point = before + parts_of(shape.number_type);
  std::vector<double> values;
  while (values.size() < shape.count * per_point) {
    if (!lines.next()) {
      return lines.truncated();
    }
    if (lines.is_delimiter()) {
      return lines.bad(
          fmt::format("the data end after {} of {} points", values.size() / per_point, shape.count),
          "the file is truncated; export it again");
    }
    for (const std::string_view word : uff_words(lines.line())) {
      const auto value = uff_number(word);
      if (!value) {
        return lines.bad(fmt::format("\"{}\" is not a number", word.substr(0, 40)),
                         "export the response again");
      }
      values.push_back(*value);
    }
  }
  for (std::size_t at = 0; at < shape.count * per_point; at += per_point) {
    put(shape, out, values[at], values[at + before],
        per_point - before == 2 ? values[at + before + 1] : 0.0);
  }
  return std::nullopt;
}

}  // namespace

// "    58b     1     2          11        1608": byte order, number format, text lines, bytes.
Result<UffForm> uff_form(std::string_view kind, const UffLines& lines) {
  UffForm out;
  if (kind.size() < 3) {
    return out;
  }
  const auto words = uff_words(kind.substr(3));
  std::array<long, 4> field{};
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i] = (i < words.size() ? uff_whole(words[i]) : std::nullopt).value_or(-1);
  }
  const std::string head = "dataset 58b: the binary form ";
  constexpr const char* kWay = "export it as text (UFF ASCII), or with IEEE numbers";
  if (field[1] == 1 || field[1] == 3) {
    return std::unexpected(lines.bad(
        head + (field[1] == 1 ? "with VAX (DEC VMS) numbers" : "with IBM 370 numbers"), kWay));
  }
  if (field[1] != 2 || (field[0] != 1 && field[0] != 2)) {
    return std::unexpected(lines.bad(
        head + "needs byte order 1 or 2 and number format 2 (IEEE) in its first line", kWay));
  }
  constexpr long kLines = 11;
  if (field[2] != kLines) {
    return std::unexpected(lines.bad(
        head + fmt::format("announces {} lines of text; 11 are defined", field[2]), kWay));
  }
  out.bytes = field[0] == 1 ? UffForm::Bytes::little_endian : UffForm::Bytes::big_endian;
  out.announced = static_cast<std::size_t>(std::max(0L, field[3]));
  return out;
}

Result<UffShape> uff_shape(UffLines& lines, bool over_time) {
  if (!lines.next()) {
    return std::unexpected(lines.truncated());
  }
  const auto words = uff_words(lines.line());
  std::array<long, 3> head{};
  for (std::size_t i = 0; i < head.size(); ++i) {
    const auto value = i < words.size() ? uff_whole(words[i]) : std::nullopt;
    if (!value) {
      return std::unexpected(lines.bad("a whole number is missing in this record",
                                       "the file may be truncated here; export it again"));
    }
    head[i] = *value;
  }
  if (head[0] != 2 && head[0] != 4 && head[0] != 5 && head[0] != 6) {
    return std::unexpected(
        lines.bad(fmt::format("ordinate data type {}; allowed: 2, 4, 5, 6", head[0]),
                  "export real and imaginary part"));
  }
  if (head[1] < 1 || static_cast<std::size_t>(head[1]) > kMostValues) {
    return std::unexpected(
        lines.bad(fmt::format("{} values; allowed: 1 … {}", head[1], kMostValues),
                  "export the response again"));
  }
  const auto field = [&words](std::size_t i) {
    return (i < words.size() ? uff_number(words[i]) : std::nullopt).value_or(-1.0);
  };
  UffShape out{static_cast<int>(head[0]), static_cast<std::size_t>(head[1]), head[2] == 1, field(3),
               field(4)};
  if (out.even && !((over_time || out.first >= 0.0) && out.step > 0.0)) {
    return std::unexpected(lines.bad("even abscissa without a first value and a step above 0",
                                     "export the response again"));
  }
  return out;
}

std::optional<Refusal> uff_values(const UffForm& form, const UffShape& shape, UffLines& lines,
                                  UffFunction& out) {
  out.number_type = shape.number_type;
  return form.bytes == UffForm::Bytes::none ? from_text(shape, lines, out)
                                            : from_bytes(form, shape, lines, out);
}

}  // namespace steadyrest::chatter::offline
