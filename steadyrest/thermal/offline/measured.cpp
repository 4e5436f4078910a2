// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/thermal/offline/log_table.hpp>
#include <steadyrest/thermal/offline/measured.hpp>
#include <steadyrest/thermal/offline/row_splitter.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

enum class Field : std::uint8_t { part, axis, transition, time, deviation, tolerance };

struct Known {
  std::string_view name;
  Field field;
  double factor;  ///< into s or mm
};
constexpr std::array kKnown = {
    Known{"part", Field::part, 0.0},
    Known{"axis", Field::axis, 0.0},
    Known{"transition", Field::transition, 0.0},
    Known{"time_min", Field::time, 60.0},
    Known{"time_s", Field::time, 1.0},
    Known{"time_h", Field::time, 3600.0},
    Known{"deviation_um", Field::deviation, 1e-3},
    Known{"deviation_mm", Field::deviation, 1.0},
    Known{"tolerance_um", Field::tolerance, 1e-3},
    Known{"tolerance_mm", Field::tolerance, 1.0},
};

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  Result<std::vector<Measured>> read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) {
      text.remove_prefix(kByteOrderMark.size());
    }
    while (!text.empty() && !fault_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      if (const auto row = trimmed(text.substr(0, end)); !row.empty() && row.front() != '#') {
        split(text.substr(0, end));
        column_.empty() ? head() : take();
      }
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!fault_ && out_.empty()) {
      line_ = 0;
      refuse("there is no measured part in it",
             "give a CSV with the columns part, transition or time_min, deviation_um");
    }
    if (fault_) {
      return std::unexpected(std::move(*fault_));
    }
    return std::move(out_);
  }

 private:
  void refuse(std::string what, std::string to_do) {
    fault_ = Refusal{Kind::bad_input, file_, line_, std::move(what), std::move(to_do)};
  }

  void split(std::string_view row) {
    if (column_.empty()) {
      splitter_.head(row);
    }
    splitter_.split(row, fields_);
  }

  [[nodiscard]] bool has(Field field) const {
    return std::ranges::find(column_, field, &Known::field) != column_.end();
  }

  void head() {
    for (const std::string_view name : fields_) {
      const auto* known = std::ranges::find(kKnown, name, &Known::name);
      if (known == kKnown.end()) {
        return refuse(fmt::format("the column {} is not known", shown(name)),
                      "part, transition, time_min, deviation_um, tolerance_um and axis are; "
                      "units stand at the end of the name");
      }
      if (has(known->field)) {
        return refuse(fmt::format("there are two columns for {}", shown(name)),
                      "leave one of them");
      }
      column_.push_back(*known);
    }
    if (!has(Field::deviation)) {
      refuse("there is no column deviation_um", "give the measured deviations in µm");
    } else if (has(Field::transition) == has(Field::time)) {
      refuse("there must be a column transition or time_min, one of them",
             "say in which transition, or how many minutes after the start, it was cut");
    }
  }

  void take() {
    if (fields_.size() != column_.size()) {
      return refuse(
          fmt::format("the row has {} fields, the head {}", fields_.size(), column_.size()),
          "give each row a field for each column, decimals with a point");
    }
    if (out_.size() >= kMostMeasured) {
      return refuse(fmt::format("more than {} rows", kMostMeasured), "give fewer parts at once");
    }
    Measured row;
    row.line = line_;
    for (std::size_t i = 0; i < column_.size() && !fault_; ++i) {
      put(row, column_[i], fields_[i]);
    }
    out_.push_back(std::move(row));
  }

  void put(Measured& row, const Known& column, std::string_view field) {
    switch (column.field) {
      case Field::part:
        row.part = shown(field);
        return;
      case Field::axis:
        row.axis = std::string(field);
        return;
      case Field::transition:
        row.transition = std::string(field);
        if (field.empty()) {
          refuse("the transition is empty", "write its number, from 1, or its name");
        }
        return;
      case Field::time:
        row.time_s = number(column, field, 0.0, 1e8);
        return;
      case Field::deviation:
        row.deviation_mm = number(column, field, -kLargestDeviation_mm, kLargestDeviation_mm);
        return;
      case Field::tolerance:
        row.tolerance_mm = number(column, field, 1e-5, 100.0);
        return;
    }
  }

  double number(const Known& column, std::string_view field, double least, double most) {
    double value = 0.0;
    const auto parsed = std::from_chars(field.begin(), field.end(), value);
    if (parsed.ec != std::errc{} || parsed.ptr != field.end() || !std::isfinite(value)) {
      refuse(fmt::format("{} = \"{}\" is not a finite number", column.name, shown(field)),
             "write numbers with a decimal point");
    } else if (value * column.factor < least || value * column.factor > most) {
      refuse(fmt::format("{} = {} cannot be; {:.6g} … {:.6g} can", column.name, shown(field),
                         least / column.factor, most / column.factor),
             "look at the unit");
    }
    return value * column.factor;
  }

  std::string file_;
  std::size_t line_ = 0;
  RowSplitter splitter_;
  std::vector<std::string_view> fields_;
  std::vector<Known> column_;
  std::vector<Measured> out_;
  std::optional<Refusal> fault_;
};

}  // namespace

Result<std::vector<Measured>> parse_measured(std::string_view text, const std::string& file) {
  return Reader(file).read(text);
}

Result<std::vector<Measured>> read_measured(const std::string& path) {
  auto text = read_packed(path);
  if (!text) {
    text.error().to_do =
        "give the path of a CSV of measured parts, with part, transition or "
        "time_min, deviation_um";
    return std::unexpected(std::move(text.error()));
  }
  return parse_measured(*text, path);
}

}  // namespace steadyrest::thermal::offline
