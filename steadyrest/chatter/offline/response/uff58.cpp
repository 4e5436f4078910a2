// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff58.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Universal files are Fortran records of 80 columns: −1 opens and closes a dataset, five title
// lines, record 6 gives the function, record 7 the form of the data, records 8 to 11 the axes.
// Other datasets between the responses are skipped; a truncated one is refused, since a cut-off
// response would fit modes that do not exist.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

// Codes of universal file dataset 58: function type, axis data types, ordinate data type.
constexpr int kFrequencyResponse = 4;
constexpr int kFrequency = 18;
constexpr int kDisplacement = 8;
constexpr int kVelocity = 11;
constexpr int kAcceleration = 12;
constexpr int kForce = 13;
constexpr int kComplexSingle = 5;
constexpr int kComplexDouble = 6;
constexpr std::size_t kMostValues = 10'000'000;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \r");
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(" \r") - begin + 1);
}

/// The blank-separated words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \r\t");
    if (begin == std::string_view::npos) {
      return out;
    }
    line.remove_prefix(begin);
    const std::size_t end = line.find_first_of(" \r\t");
    out.push_back(line.substr(0, end));
    if (end == std::string_view::npos) {
      return out;
    }
    line.remove_prefix(end);
  }
}

/// Fortran writes 1.0D+00 as well.
std::optional<double> number(std::string_view word) {
  std::string text(word);
  for (char& c : text) {
    c = c == 'D' || c == 'd' ? 'E' : c;
  }
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// One axis: records 8, 9, 10.
struct Axis {
  int kind = 0;
  std::string unit;  ///< of the label; empty: SI
};

class UffReader {
 public:
  UffReader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  Result<std::vector<Frf>> read() {
    while (next()) {
      if (trimmed(line_) != "-1") {
        continue;
      }
      if (!next()) {
        break;
      }
      const std::string_view kind = trimmed(line_);
      if (kind.starts_with("58") && kind.size() > 2) {
        return std::unexpected(bad(fmt::format("dataset {}: the binary form", kind.substr(0, 20)),
                                   "export the response as text (UFF ASCII)"));
      }
      if (kind == "58") {
        if (auto fault = dataset()) {
          return std::unexpected(std::move(*fault));
        }
      } else if (!pass_over()) {
        return std::unexpected(truncated());
      }
    }
    if (out_.empty()) {
      at_ = 0;
      return std::unexpected(
          bad("has no dataset 58", "export frequency responses (UFF dataset 58)"));
    }
    return std::move(out_);
  }

 private:
  bool next() {
    if (rest_.empty()) {
      return false;
    }
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++at_;
    return true;
  }

  /// To the −1 that ends a dataset.
  bool pass_over() {
    while (next()) {
      if (trimmed(line_) == "-1") {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] Refusal bad(std::string what, std::string to_do) const {
    return bad_input(file_, at_, std::move(what), std::move(to_do));
  }
  [[nodiscard]] Refusal truncated() const {
    return bad("the file ends within a dataset", "it is truncated; export it again");
  }

  std::optional<Refusal> dataset() {
    constexpr int kTitles = 5;
    for (int i = 0; i < kTitles; ++i) {
      if (!next()) {
        return truncated();
      }
    }
    int function = 0;
    if (auto fault = integers(std::span(&function, 1))) {
      return fault;
    }
    if (function != kFrequencyResponse) {
      return bad(
          fmt::format("function type {}; a frequency response is {}", function, kFrequencyResponse),
          "export only frequency responses");
    }
    if (auto fault = form()) {
      return fault;
    }
    Axis abscissa;
    Axis response;
    Axis force;
    Axis z;
    // Order of the records is fixed: abscissa, ordinate numerator, denominator, z axis.
    for (Axis* axis : {&abscissa, &response, &force, &z}) {
      if (auto fault = characteristics(*axis)) {
        return fault;
      }
      if (axis == &abscissa && axis->kind != kFrequency) {
        return bad(fmt::format("abscissa of type {}; frequency is {}", axis->kind, kFrequency),
                   "export over frequency in Hz");
      }
      if (axis == &response && !response_scale(*axis)) {
        return bad(fmt::format("ordinate of type {} in \"{}\"; allowed: displacement (8), "
                               "velocity (11) and acceleration (12) in m, mm, um, their rates, g",
                               axis->kind, axis->unit),
                   "export with SI units");
      }
      if (axis == &force && !force_scale(*axis)) {
        return bad(fmt::format("denominator of type {} in \"{}\"; allowed: force (13) in N, kN",
                               axis->kind, axis->unit),
                   "export the response to a force");
      }
    }
    return data(response, *response_scale(response) / *force_scale(force));
  }

  /// The first fields of a record.
  std::optional<Refusal> integers(std::span<int> out) {
    if (!next()) {
      return truncated();
    }
    const auto words = words_of(line_);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto value = i < words.size() ? number(words[i]) : std::nullopt;
      if (!value || std::abs(*value) > 1e9 || *value != std::floor(*value)) {
        return bad("a whole number is missing in this record",
                   "the file may be truncated here; export it again");
      }
      out[i] = static_cast<int>(*value);
    }
    return std::nullopt;
  }

  /// Record 7: kind of numbers, how many, spacing, first abscissa, step.
  std::optional<Refusal> form() {
    std::array<int, 3> head{};
    if (auto fault = integers(head)) {
      return fault;
    }
    if (head[0] != kComplexSingle && head[0] != kComplexDouble) {
      return bad(fmt::format("ordinate data type {}; complex is 5 (single) or 6 (double)", head[0]),
                 "export real and imaginary part");
    }
    if (head[1] < 1 || static_cast<std::size_t>(head[1]) > kMostValues) {
      return bad(fmt::format("{} values; allowed: 1 … {}", head[1], kMostValues),
                 "export the response again");
    }
    count_ = static_cast<std::size_t>(head[1]);
    even_ = head[2] == 1;
    const auto words = words_of(line_);
    const auto field = [&words](std::size_t i) {
      const auto value = i < words.size() ? number(words[i]) : std::nullopt;
      return value ? *value : -1.0;
    };
    first_hz_ = field(3);
    step_hz_ = field(4);
    if (even_ && !(first_hz_ >= 0.0 && step_hz_ > 0.0)) {
      return bad("even abscissa without a first frequency and a step above 0",
                 "export the response again");
    }
    return std::nullopt;
  }

  /// Records 8 … 11: type (10 columns), three exponents (5 each), label and unit (1 + 20 each).
  std::optional<Refusal> characteristics(Axis& axis) {
    if (auto fault = integers(std::span(&axis.kind, 1))) {
      return fault;
    }
    // By column, not by word: the label before the unit may be blank or contain blanks.
    constexpr std::size_t kUnitAt = 47;
    const std::string_view unit =
        line_.size() > kUnitAt ? trimmed(line_.substr(kUnitAt, 20)) : std::string_view();
    axis.unit = unit == "NONE" ? "" : std::string(unit);
    return std::nullopt;
  }

  /// To mm, mm/s, mm/s².
  static std::optional<double> response_scale(const Axis& axis) {
    using Row = std::pair<std::string_view, double>;
    static constexpr std::array kLength = {Row{"", 1e3}, Row{"m", 1e3}, Row{"mm", 1.0},
                                           Row{"um", 1e-3}};
    static constexpr std::array kSpeed = {Row{"", 1e3}, Row{"m/s", 1e3}, Row{"mm/s", 1.0}};
    static constexpr std::array kAccelerations = {
        Row{"", 1e3},       Row{"m/s^2", 1e3}, Row{"m/s2", 1e3}, Row{"m/s**2", 1e3},
        Row{"mm/s^2", 1.0}, Row{"mm/s2", 1.0}, Row{"g", 9806.65}};
    const auto find = [&axis](std::span<const Row> rows) -> std::optional<double> {
      for (const auto& [unit, scale] : rows) {
        if (unit == axis.unit) {
          return scale;
        }
      }
      return std::nullopt;
    };
    return axis.kind == kDisplacement   ? find(kLength)
           : axis.kind == kVelocity     ? find(kSpeed)
           : axis.kind == kAcceleration ? find(kAccelerations)
                                        : std::nullopt;
  }

  static std::optional<double> force_scale(const Axis& axis) {
    if (axis.kind != kForce) {
      return std::nullopt;
    }
    return axis.unit.empty() || axis.unit == "N" ? std::optional(1.0)
           : axis.unit == "kN"                   ? std::optional(1e3)
                                                 : std::nullopt;
  }

  std::optional<Refusal> data(const Axis& response, double scale) {
    // Real, imaginary; over uneven frequencies with the frequency in front. Values per line vary
    // with the number type, so values are counted, not lines.
    const std::size_t per_point = even_ ? 2 : 3;
    std::vector<double> values;
    while (values.size() < count_ * per_point) {
      if (!next()) {
        return truncated();
      }
      if (trimmed(line_) == "-1") {
        return bad(
            fmt::format("the data end after {} of {} points", values.size() / per_point, count_),
            "the file is truncated; export it again");
      }
      for (const std::string_view word : words_of(line_)) {
        const auto value = number(word);
        if (!value) {
          return bad(fmt::format("\"{}\" is not a number", word.substr(0, 40)),
                     "export the response again");
        }
        values.push_back(*value);
      }
    }
    if (auto fault = put(values, response, scale)) {
      return fault;
    }
    return pass_over() ? std::nullopt : std::optional(truncated());
  }

  std::optional<Refusal> put(const std::vector<double>& values, const Axis& response,
                             double scale) {
    Frf frf;
    frf.measured_order = response.kind == kAcceleration ? 2 : response.kind == kVelocity ? 1 : 0;
    double last = -1.0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double* at = values.data() + i * (even_ ? 2 : 3);
      const double f = even_ ? first_hz_ + static_cast<double>(i) * step_hz_ : at[0];
      const std::complex<double> h(at[even_ ? 0 : 1], at[even_ ? 1 : 2]);
      if (!(f > last)) {
        return bad(fmt::format("frequency {} Hz after {} Hz", f, last),
                   "export with rising frequencies");
      }
      last = f;
      // Division by (iω)² or iω: at 0 Hz acceleration and velocity say nothing about displacement.
      if (f <= 0.0) {
        continue;
      }
      const std::complex<double> compliance = displacement_of(scale * h, f, frf.measured_order);
      if (!possible(compliance)) {
        return bad(fmt::format("the response at {} Hz is out of range", f), "check the units");
      }
      frf.frequency_hz.push_back(f);
      frf.compliance_mm_n.push_back(compliance);
    }
    if (frf.frequency_hz.size() < kLeastPoints) {
      return bad(fmt::format("{} points above 0 Hz; at least {} are needed",
                             frf.frequency_hz.size(), kLeastPoints),
                 "give the whole response");
    }
    out_.push_back(std::move(frf));
    return std::nullopt;
  }

  std::string_view rest_;
  std::string_view line_;
  std::size_t at_ = 0;
  const std::string& file_;
  std::vector<Frf> out_;
  std::size_t count_ = 0;
  bool even_ = true;
  double first_hz_ = 0.0;
  double step_hz_ = 0.0;
};

}  // namespace

Result<std::vector<Frf>> parse_uff58(std::string_view text, const std::string& file) {
  return UffReader(text, file).read();
}

}  // namespace steadyrest::chatter::offline
