// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/frf.hpp>
#include <steadyrest/chatter/offline/uff58.hpp>
#include <steadyrest/kernel/machine/text_file.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

/// A column's name and its unit, both in small letters: `real`, `um/n`.
struct Head {
  std::string name;
  std::string unit;
};

Head head_of(std::string_view cell) {
  std::string word;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const auto c = static_cast<unsigned char>(cell[i]);
    if (c >= 0x80U) {  // µ in either of its two codes
      word += 'u';
      ++i;
    } else if (c > ' ' && c != '"' && c != ']' && c != ')') {
      word += static_cast<char>(std::tolower(c));
    }
  }
  const std::size_t end = word.find_first_of("_([");
  Head out{word.substr(0, end), end == std::string::npos ? "" : word.substr(end + 1)};
  std::ranges::replace(out.unit, '_', '/');
  return out;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t at = line.find_first_of(",;\t");
    out.push_back(line.substr(0, at));
    if (at == std::string_view::npos) {
      return out;
    }
    line.remove_prefix(at + 1);
  }
}

std::optional<double> number(std::string_view cell) {
  const std::string text(cell);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  while (*end == ' ' || *end == '\r') {
    ++end;
  }
  if (end == text.c_str() || *end != '\0' || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

class CsvReader {
 public:
  explicit CsvReader(const std::string& file) : file_(file) {}

  Result<Frf> read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view row = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_;
      const std::size_t begin = row.find_first_not_of(" \t\r");
      if (begin == std::string_view::npos || row[begin] == '#') {
        continue;
      }
      if (const auto fault = columns_ == 0 ? head(row) : values(row)) {
        return std::unexpected(*fault);
      }
    }
    if (out_.frequency_hz.size() < kLeastPoints) {
      line_ = 0;
      return std::unexpected(bad(fmt::format("has {} points above 0 Hz; at least {} are needed",
                                             out_.frequency_hz.size(), kLeastPoints),
                                 "give the whole response"));
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] Refusal bad(std::string what, std::string to_do) const {
    return {Kind::bad_input, file_, line_, std::move(what), std::move(to_do)};
  }

  std::optional<Refusal> head(std::string_view row) {
    const auto cells = cells_of(row);
    constexpr std::string_view kWay =
        "begin with frequency_hz,real_um_N,imag_um_N or frequency_hz,magnitude_um_N,phase_deg";
    if (cells.size() != 3) {
      return bad(fmt::format("the head has {} columns; 3 are needed", cells.size()),
                 std::string(kWay));
    }
    const std::array head = {head_of(cells[0]), head_of(cells[1]), head_of(cells[2])};
    polar_ = head[1].name == "magnitude";
    if (head[0].name != "frequency" || (!polar_ && head[1].name != "real") ||
        head[2].name != (polar_ ? "phase" : "imag")) {
      return bad(fmt::format("the head is {},{},{}", head[0].name, head[1].name, head[2].name),
                 std::string(kWay));
    }
    if (head[0].unit != "hz") {
      return bad(fmt::format("frequency in \"{}\"; allowed is Hz", head[0].unit),
                 "write frequency_hz");
    }
    if (!scale(head[1].unit) || (polar_ ? head[2].unit != "deg" : head[2].unit != head[1].unit)) {
      return bad(fmt::format(R"(units "{}" and "{}"; allowed are m/N, mm/N, um/N{})", head[1].unit,
                             head[2].unit, polar_ ? " and deg" : ", the same in both"),
                 std::string(kWay));
    }
    mm_n_ = *scale(head[1].unit);
    columns_ = cells.size();
    return std::nullopt;
  }

  static std::optional<double> scale(std::string_view unit) {
    return unit == "m/n"    ? std::optional(1e3)
           : unit == "mm/n" ? std::optional(1.0)
           : unit == "um/n" ? std::optional(1e-3)
                            : std::nullopt;
  }

  std::optional<Refusal> values(std::string_view row) {
    const auto cells = cells_of(row);
    if (cells.size() != columns_) {
      return bad(fmt::format("{} values; {} are needed", cells.size(), columns_),
                 "the file may be cut off here; export it again");
    }
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto read = number(cells[i]);
      if (!read) {
        return bad(fmt::format("\"{}\" is no number", cells[i].substr(0, 40)),
                   "write a decimal point and no unit");
      }
      value[i] = *read;
    }
    if (!seen_.empty() && !(value[0] > seen_.back())) {
      return bad(fmt::format("frequency {} Hz after {} Hz", value[0], seen_.back()),
                 "sort the rows by rising frequency");
    }
    seen_.push_back(value[0]);
    const std::complex<double> h =
        polar_ ? mm_n_ * value[1] * std::polar(1.0, value[2] * std::numbers::pi / 180.0)
               : mm_n_ * std::complex<double>(value[1], value[2]);
    if (!possible(h)) {
      return bad(fmt::format("the response at {} Hz is out of range", value[0]),
                 "check the unit in the head");
    }
    if (value[0] > 0.0) {
      out_.frequency_hz.push_back(value[0]);
      out_.compliance_mm_n.push_back(h);
    }
    return std::nullopt;
  }

  const std::string& file_;
  Frf out_;
  std::vector<double> seen_;
  std::size_t line_ = 0;
  std::size_t columns_ = 0;
  bool polar_ = false;
  double mm_n_ = 1.0;
};

/// The first line of a universal file has −1 in columns 5 and 6 and nothing else.
bool universal(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t begin = line.find_first_not_of(' ');
  return begin != std::string_view::npos && line.substr(begin, 2) == "-1" &&
         line.find_first_not_of(" \r", begin + 2) == std::string_view::npos;
}

}  // namespace

Result<Frf> parse_frf_csv(std::string_view text, const std::string& file) {
  return CsvReader(file).read(text);
}

Result<std::vector<Frf>> read_frf(const std::string& path) {
  auto text = kernel::machine::read_text(path);
  if (!text) {
    text.error().to_do = "give a measured response: CSV or universal file format 58";
    return std::unexpected(text.error());
  }
  if (universal(*text)) {
    return parse_uff58(*text, path);
  }
  auto one = parse_frf_csv(*text, path);
  if (!one) {
    return std::unexpected(one.error());
  }
  std::vector<Frf> out;
  out.push_back(std::move(*one));
  return out;
}

}  // namespace steadyrest::chatter::offline
