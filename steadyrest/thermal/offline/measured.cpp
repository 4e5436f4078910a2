// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/thermal/offline/log_table.hpp>
#include <steadyrest/thermal/offline/measured.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using table::Fault;
using table::shown;

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

class Reader final : public table::Sink {
 public:
  std::optional<Fault> head(const table::Head& head) override {
    for (const std::string& name : head.name) {
      const auto* known = std::ranges::find(kKnown, name, &Known::name);
      if (known == kKnown.end()) {
        return Fault{0, fmt::format("the column {} is not known", shown(name)),
                     "part, transition, time_min, deviation_um, tolerance_um and axis are; "
                     "units stand at the end of the name"};
      }
      if (has(known->field)) {
        return Fault{0, fmt::format("there are two columns for {}", shown(name)),
                     "leave one of them"};
      }
      column_.push_back(*known);
    }
    if (!has(Field::deviation)) {
      return Fault{0, "there is no column deviation_um", "give the measured deviations in µm"};
    }
    if (has(Field::transition) == has(Field::time)) {
      return Fault{0, "there must be a column transition or time_min, one of them",
                   "say in which transition, or how many minutes after the start, it was cut"};
    }
    return std::nullopt;
  }

  std::optional<Fault> row(const table::Row& row) override {
    if (out_.size() >= kMostMeasured) {
      return Fault{row.line(), fmt::format("more than {} rows", kMostMeasured),
                   "give fewer parts at once"};
    }
    Measured part;
    part.line = row.line();
    for (std::size_t i = 0; i < column_.size(); ++i) {
      if (auto fault = put(part, row, i)) {
        return fault;
      }
    }
    out_.push_back(std::move(part));
    return std::nullopt;
  }

  [[nodiscard]] std::vector<Measured> take() { return std::move(out_); }

 private:
  [[nodiscard]] bool has(Field field) const {
    return std::ranges::find(column_, field, &Known::field) != column_.end();
  }

  std::optional<Fault> put(Measured& part, const table::Row& row, std::size_t i) {
    const std::string_view field = row.field(i);
    switch (column_[i].field) {
      case Field::part:
        part.part = shown(field);
        return std::nullopt;
      case Field::axis:
        part.axis = std::string(field);
        return std::nullopt;
      case Field::transition:
        part.transition = std::string(field);
        return field.empty() ? std::optional(Fault{row.line(), "the transition is empty",
                                                   "write its number, from 1, or its name"})
                             : std::nullopt;
      case Field::time:
        return number(row, i, 0.0, 1e8, part.time_s);
      case Field::deviation:
        return number(row, i, -kLargestDeviation_mm, kLargestDeviation_mm, part.deviation_mm);
      case Field::tolerance:
        return number(row, i, 1e-5, 100.0, part.tolerance_mm);
    }
    return std::nullopt;
  }

  std::optional<Fault> number(const table::Row& row, std::size_t i, double least, double most,
                              double& to) const {
    const Known& column = column_[i];
    const auto value = row.number(i);
    if (!value) {
      return value.error();
    }
    to = *value * column.factor;
    if (to < least || to > most) {
      return Fault{row.line(),
                   fmt::format("{} = {} cannot be; {:.6g} … {:.6g} can", column.name,
                               shown(row.field(i)), least / column.factor, most / column.factor),
                   "look at the unit"};
    }
    return std::nullopt;
  }

  std::vector<Known> column_;
  std::vector<Measured> out_;
};

}  // namespace

Result<std::vector<Measured>> parse_measured(std::string_view text, const std::string& file,
                                             const table::Format& format) {
  Reader reader;
  table::RowReader rows(format, reader);
  auto fault = table::read_rows(text, rows);
  std::vector<Measured> out = reader.take();
  if (!fault && out.empty()) {
    fault = Fault{0, "there is no measured part in it",
                  "give a CSV with the columns part, transition or time_min, deviation_um"};
  }
  if (fault) {
    return std::unexpected(Refusal{Kind::bad_input, file, fault->line, fault->what, fault->to_do});
  }
  return out;
}

Result<std::vector<Measured>> read_measured(const std::string& path, const table::Format& format) {
  auto text = read_packed(path);
  if (!text) {
    text.error().to_do =
        "give the path of a CSV of measured parts, with part, transition or "
        "time_min, deviation_um";
    return std::unexpected(std::move(text.error()));
  }
  return parse_measured(*text, path, format);
}

}  // namespace steadyrest::thermal::offline
