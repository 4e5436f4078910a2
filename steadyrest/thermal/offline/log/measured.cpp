// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/packed_file.hpp>
#include <steadyrest/thermal/offline/log/log_table.hpp>
#include <steadyrest/thermal/offline/log/measured.hpp>

// Gauging reports come from people: columns in any order, units in the name, `;` or `,`. An unknown
// column is refused, not skipped, since a misspelt tolerance_um would silently change the level.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using table::Fault;
using table::shown;

enum class Field : std::uint8_t {
  part,
  axis,
  transition,
  time,
  stamp,
  deviation,
  tolerance,
  passed_over
};

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
  explicit Reader(const std::optional<table::Stamp>& started) : started_(started) {}

  std::optional<Fault> head(const table::Head& head) override {
    for (const std::string& name : head.name) {
      // Stamps may have a column of any name; a column without a name is a separator at the end of
      // the line.
      const bool stamp = head.stamped == column_.size();
      if (name.empty() || stamp || head.clocked == column_.size()) {
        column_.push_back({"time", stamp ? Field::stamp : Field::passed_over, 1.0});
        if (stamp) {
          stamps_.emplace(head, column_.size() - 1);
        }
        continue;
      }
      const auto* known = std::ranges::find(kKnown, name, &Known::name);
      if (known == kKnown.end()) {
        return Fault{0, fmt::format("the column {} is unknown", shown(name)),
                     "use part, transition, time_min, deviation_um, tolerance_um and axis, with "
                     "units at the end of the name"};
      }
      if (has(known->field)) {
        return Fault{0, fmt::format("there are two columns for {}", shown(name)),
                     "keep one of them"};
      }
      column_.push_back(*known);
    }
    if (!has(Field::deviation)) {
      return Fault{0, "there is no column deviation_um", "give the measured deviations in µm"};
    }
    if (has(Field::transition) || has(Field::time)) {  // stamps give the time of gauging
      for (Known& column : column_) {
        column.field = column.field == Field::stamp ? Field::passed_over : column.field;
      }
    }
    // A part needs one instant in the plan: two statements of it may disagree.
    if (static_cast<int>(has(Field::transition)) + static_cast<int>(has(Field::time)) +
            static_cast<int>(has(Field::stamp)) !=
        1) {
      return Fault{
          0, "give exactly one of the columns transition, time_min or stamps",
          "say in which transition, or how many minutes after the start, the part was cut"};
    }
    if (has(Field::stamp) && !started_) {
      return Fault{head.line + 1,
                   "the parts have time stamps, but the start of the plan's work is missing",
                   "give --started 2026-11-22T23:47:06, or time_min since then"};
    }
    return std::nullopt;
  }

  // A limit on the rows keeps a log given by mistake from being read as parts.
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

  // The header gives each column's quantity and factor; here a field only goes to its place.
  std::optional<Fault> put(Measured& part, const table::Row& row, std::size_t i) {
    const std::string_view field = row.field(i);
    switch (column_[i].field) {
      case Field::part:
        part.part = shown(field);
        return std::nullopt;
      // Empty where the plan has one axis; the caller checks the name against the plan.
      case Field::axis:
        part.axis = std::string(field);
        return std::nullopt;
      case Field::transition:
        part.transition = std::string(field);
        return field.empty() ? std::optional(Fault{row.line(), "the transition is empty",
                                                   "write its number, from 1, or its name"})
                             : std::nullopt;
      case Field::passed_over:
        return std::nullopt;
      case Field::stamp:
        return since_start(row, i, part.time_s);
      case Field::time:
        return number(row, i, 0.0, 1e8, part.time_s);
      case Field::deviation:
        // Bounds catch µm in a column of mm: a deviation of 4.2 mm is no thermal drift.
        return number(row, i, -kLargestDeviation_mm, kLargestDeviation_mm, part.deviation_mm);
      // A tolerance below 10 nm is a wrong unit.
      case Field::tolerance:
        return number(row, i, 1e-5, 100.0, part.tolerance_mm);
    }
    return std::nullopt;
  }

  std::optional<Fault> since_start(const table::Row& row, std::size_t i, double& to_s) {
    const auto stamp = stamps_->read(row);
    if (!stamp) {
      return stamp.error();
    }
    // With a zone on one side only, the difference of two stamps is off by hours.
    if (stamp->zoned != started_->zoned) {
      return Fault{row.line(),
                   fmt::format("\"{}\" is not a date and time {} a time zone", shown(row.field(i)),
                               started_->zoned ? "with" : "without"),
                   "write each stamp like --started, 2026-11-22T23:47:06"};
    }
    // Whole seconds and fractions separately: seconds since 1970 leave a double only some 1e-7 s.
    to_s = static_cast<double>(stamp->whole_s - started_->whole_s) + stamp->fraction_s -
           started_->fraction_s;
    if (!(to_s >= 0.0)) {
      return Fault{row.line(), fmt::format("{} is before --started", shown(row.field(i))),
                   "give the time when the plan's work began"};
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
                   fmt::format("{} = {} is implausible; {:.6g} … {:.6g} is allowed", column.name,
                               shown(row.field(i)), least / column.factor, most / column.factor),
                   "check the unit"};
    }
    return std::nullopt;
  }

  const std::optional<table::Stamp>& started_;
  std::optional<table::StampReader> stamps_;
  std::vector<Known> column_;
  std::vector<Measured> out_;
};

}  // namespace

Result<std::vector<Measured>> parse_measured(std::string_view text, const std::string& file,
                                             const MeasuredFormat& format) {
  Reader reader(format.started);
  table::RowReader rows(format.table, reader);
  auto fault = table::read_rows(text, rows);
  std::vector<Measured> out = reader.take();
  // A header alone would change no level and no gain, and look like success.
  if (!fault && out.empty()) {
    fault = Fault{0, "has no measured part",
                  "give a CSV with columns part, transition or time_min, deviation_um"};
  }
  if (fault) {
    return refuse(file, fault->line, fault->what, fault->to_do);
  }
  return out;
}

Result<std::vector<Measured>> read_measured(const std::string& path, const MeasuredFormat& format) {
  auto text = table::read_packed(path);
  if (!text) {
    text.error().to_do =
        "give the path of a CSV of measured parts, with columns part, transition or time_min, "
        "deviation_um";
    return std::unexpected(std::move(text.error()));
  }
  return parse_measured(*text, path, format);
}

}  // namespace steadyrest::thermal::offline
