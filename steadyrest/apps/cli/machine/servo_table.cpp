// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/servo_table.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::apps::cli {
namespace servo_table_reader {
namespace {

using table::Fault;

struct LengthUnit {
  std::string_view name;
  double to_inner;
};
constexpr std::array<LengthUnit, 7> kLengthUnits = {{{"mm", 1.0},
                                                     {"um", 1e-3},
                                                     {"m", 1e3},
                                                     {"inch", 25.4},
                                                     {"in", 25.4},
                                                     {"rad", 1.0},
                                                     {"deg", std::numbers::pi / 180.0}}};

/// A column of positions, with its unit.
struct Column {
  std::size_t place = 0;
  double to_inner = 1.0;
};

/// Columns of one axis. The second is the actual position, or the following error.
struct AxisColumns {
  Column command;
  Column second;
  bool following = false;
};

/// `x_cmd_mm` for the stem `x_cmd_`.
std::optional<Column> with_stem(const table::Head& head, const std::string& stem) {
  for (std::size_t i = 0; i < head.name.size(); ++i) {
    const std::string name = table::lower(head.name[i]);
    for (const LengthUnit& unit : kLengthUnits) {
      if (name == stem + std::string(unit.name)) {
        return Column{i, unit.to_inner};
      }
    }
  }
  return std::nullopt;
}

class ServoSink final : public table::Sink {
 public:
  ServoSink(const ServoSource& source, const table::Format& format)
      : source_(source), format_(format), logs_(source.places.size()) {}

  std::optional<Fault> head(const table::Head& head) override {
    if (auto fault = head.twice()) {
      return fault;
    }
    axes_ = head.place("axis_count");
    clock_ = table::Clock::of(head, format_);
    for (const std::size_t place : source_.places) {
      const std::string axis = table::lower(source_.machine.axes[place].name);
      const auto ours = [&](std::string_view which) -> std::optional<Column> {
        const auto found = head.place(fmt::format("axis.{}_mm.{}", which, place));
        return found ? std::optional(Column{*found, 1.0}) : std::nullopt;
      };
      auto command = ours("command");
      auto actual = ours("actual");
      command = command ? command : with_stem(head, axis + "_cmd_");
      actual = actual ? actual : with_stem(head, axis + "_act_");
      const auto error = actual ? std::nullopt : with_stem(head, axis + "_err_");
      if (!clock_ || !command || (!actual && !error)) {
        return missing(head, place, axis, command.has_value());
      }
      columns_.push_back({*command, actual ? *actual : *error, !actual.has_value()});
    }
    return std::nullopt;
  }

  std::optional<Fault> row(const table::Row& row) override {
    const auto time_s = clock_->seconds(row);
    if (!time_s) {
      return time_s.error();
    }
    if (axes_) {
      const auto axes = row.number(*axes_);
      if (!axes) {
        return axes.error();
      }
      if (*axes != static_cast<double>(source_.machine.axes.size())) {
        return Fault{
            row.line(),
            fmt::format("has {} axes, the machine file has {}", *axes, source_.machine.axes.size()),
            "give the machine file of the machine that was recorded"};
      }
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const AxisColumns& axis = columns_[i];
      const auto command = row.number(axis.command.place);
      const auto second = row.number(axis.second.place);
      if (!command || !second) {
        return !command ? command.error() : second.error();
      }
      const double position = *command * axis.command.to_inner;
      const double other = *second * axis.second.to_inner;
      logs_[i].time_s.push_back(*time_s);
      logs_[i].command.push_back(position);
      logs_[i].actual.push_back(axis.following ? position - other : other);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<contour::offline::ServoLog> take() { return std::move(logs_); }

 private:
  /// The first that is missing, by the names that the file seems to use.
  [[nodiscard]] Fault missing(const table::Head& head, std::size_t place, const std::string& axis,
                              bool has_command) const {
    const bool shorter =
        has_command || std::ranges::any_of(head.name, [](const auto& name) {
          return name.find("_cmd_") != std::string::npos || name.find("_act_") != std::string::npos;
        });
    const bool timed = clock_ && (shorter || head.place("time_s"));
    const std::string name =
        !timed    ? (shorter ? "t_s" : "time_s")
        : shorter ? axis + (has_command ? "_act_mm" : "_cmd_mm")
                  : fmt::format("axis.{}_mm.{}", has_command ? "actual" : "command", place);
    return {head.line, fmt::format("the column {} is missing in the header", name),
            fmt::format("give a record of a run, the table that `record export` makes of one, or "
                        "name the columns, as --columns t_s,{0}_cmd_mm,{0}_act_mm",
                        axis)};
  }

  const ServoSource& source_;
  const table::Format& format_;
  std::vector<contour::offline::ServoLog> logs_;
  std::optional<table::Clock> clock_;
  std::optional<std::size_t> axes_;
  std::vector<AxisColumns> columns_;
};

}  // namespace
}  // namespace servo_table_reader

kernel::outcome::Result<RecordedServos> servo_table(const std::string& file, std::istream& in,
                                                    const ServoSource& source) {
  const table::Format format = format_of(source.options);
  servo_table_reader::ServoSink sink(source, format);
  table::RowReader rows(format, sink);
  std::string line;
  std::optional<table::Fault> fault;
  while (!fault && std::getline(in, line)) {
    fault = rows.line(line);
  }
  if (in.bad()) {
    return kernel::outcome::refuse(file, "cannot be read to its end",
                                   "check the disk, or copy the file again");
  }
  if (!fault) {
    fault = rows.finish();
  }
  if (fault) {
    return kernel::outcome::refuse(file, fault->line, fault->what, fault->to_do);
  }
  return RecordedServos{sink.take(), {}};
}

}  // namespace steadyrest::apps::cli
