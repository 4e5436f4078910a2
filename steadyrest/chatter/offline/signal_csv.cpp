// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal_parts.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kUneven = 0.25;  // of a step

/// The rate of a step that is nearly on a border is the border's.
double rate_of(double rate_hz) {
  return std::clamp(rate_hz, kLeastRateHz, kMostRateHz);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\r");
  const std::size_t to = text.find_last_not_of(" \t\r");
  return from == std::string_view::npos ? std::string_view{} : text.substr(from, to - from + 1);
}

class CsvReader {
 public:
  OrFault<RecordedSignal> read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) {
      text.remove_prefix(kByteOrderMark.size());
    }
    std::optional<SignalFault> fault;
    while (!text.empty() && !fault) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      if (const auto row = trimmed(text.substr(0, end)); !row.empty() && row.front() != '#') {
        fault = split(row);
      }
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!fault) {
      fault = finish();
    }
    if (fault) {
      return std::unexpected(std::move(*fault));
    }
    return std::move(out_);
  }

 private:
  std::optional<SignalFault> split(std::string_view row) {
    const bool header = fields_of_header_ == 0;
    if (header) {
      const std::size_t mark = row.find_first_of(",;\t");
      separator_ = mark == std::string_view::npos ? ',' : row[mark];
    }
    fields_.clear();
    for (std::size_t end = 0; end != std::string_view::npos; row.remove_prefix(end + 1)) {
      end = row.find(separator_);
      fields_.push_back(trimmed(row.substr(0, end)));
      if (end == std::string_view::npos) {
        break;
      }
    }
    return header ? take_header() : take_row();
  }

  std::optional<SignalFault> take_header() {
    fields_of_header_ = fields_.size();
    for (const auto& [name, place] :
         {std::pair{"t_s", &time_}, std::pair{"value", &value_}, std::pair{"speed_rpm", &speed_}}) {
      const auto count = std::ranges::count(fields_, name);
      if (count > 1 || (count == 0 && place != &speed_)) {
        return SignalFault{
            line_,
            fmt::format("the column {} {} in the header", name,
                        count ? "stands twice" : "is missing"),
            "name the columns t_s, value and, if recorded, speed_rpm in the first line"};
      }
      if (count == 1) {
        *place = static_cast<std::size_t>(std::ranges::find(fields_, name) - fields_.begin());
      }
    }
    return std::nullopt;
  }

  std::optional<SignalFault> take_row() {
    if (fields_.size() != fields_of_header_) {
      return SignalFault{
          line_, fmt::format("{} fields; the header has {}", fields_.size(), fields_of_header_),
          "give each row a field for each column, decimals with a point"};
    }
    double t_s = 0.0;
    double value = 0.0;
    double speed_rpm = 0.0;
    for (const auto& [place, number] :
         {std::pair{time_, &t_s}, std::pair{value_, &value}, std::pair{speed_, &speed_rpm}}) {
      if (place && !parse(fields_[*place], *number)) {
        return SignalFault{line_,
                           fmt::format("\"{}\" is not a finite number", shown(fields_[*place])),
                           "write numbers with a decimal point"};
      }
    }
    time_s_.push_back(t_s);
    lines_.push_back(line_);
    out_.value.push_back(value);
    if (speed_) {
      out_.speed_rev_s.push_back(kernel::units::rev_s_from_rpm(std::abs(speed_rpm)));
    }
    return std::nullopt;
  }

  static bool parse(std::string_view field, double& out) {
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), out);
    return error == std::errc{} && end == field.data() + field.size() && std::isfinite(out);
  }

  std::optional<SignalFault> finish() {
    if (time_s_.size() < 2) {
      return SignalFault{0, fmt::format("holds {} samples", time_s_.size()),
                         "give CSV with the columns t_s and value, or WAV"};
    }
    std::vector<double> steps(time_s_.size() - 1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      steps[i] = time_s_[i + 1] - time_s_[i];
    }
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    const double median_s = *middle;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!(steps[i] > 0.0 && std::abs(steps[i] - median_s) <= kUneven * median_s)) {
        return SignalFault{
            lines_[i + 1],
            fmt::format("t_s goes on by {:.6g} s, elsewhere by {:.6g} s", steps[i], median_s),
            "give samples at an even rate, none left out, t_s with enough digits"};
      }
    }
    out_.start_s = time_s_.front();
    out_.rate_hz = static_cast<double>(steps.size()) / (time_s_.back() - time_s_.front());
    auto fault = unfit_rate(out_.rate_hz);
    out_.rate_hz = rate_of(out_.rate_hz);
    return fault;
  }

  std::size_t line_ = 0;
  char separator_ = ',';
  std::size_t fields_of_header_ = 0;
  std::optional<std::size_t> time_;
  std::optional<std::size_t> value_;
  std::optional<std::size_t> speed_;
  std::vector<std::string_view> fields_;
  std::vector<double> time_s_;
  std::vector<std::size_t> lines_;
  RecordedSignal out_;
};

}  // namespace

OrFault<RecordedSignal> parse_csv_signal(std::string_view text) {
  return CsvReader().read(text);
}

}  // namespace steadyrest::chatter::offline
