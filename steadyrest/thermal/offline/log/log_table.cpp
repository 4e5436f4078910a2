// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/thermal/offline/log/log_table.hpp>

// A column's name defines it: time and speed by whole names, lengths and temperatures by their
// endings. A unit is never guessed from the numbers; a column without a known ending is ignored.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Result;
using table::Fault;

struct Unit {
  std::string_view ending;
  Quantity quantity;
  double factor;
  double offset;
};
constexpr std::array kUnits = {
    Unit{"_um", Quantity::displacement, 1e-3, 0.0},
    Unit{"_mm", Quantity::displacement, 1.0, 0.0},
    Unit{"_c", Quantity::temperature, 1.0, 0.0},
    Unit{"_k", Quantity::temperature, 1.0, -273.15},
    Unit{"_f", Quantity::temperature, 5.0 / 9.0, -160.0 / 9.0},
};
struct Named {
  std::string_view name;
  Quantity quantity;
  double factor;
};
constexpr std::array kNamed = {
    Named{"spindle_rpm", Quantity::speed, 1 / 60.0},
    Named{"speed_rpm", Quantity::speed, 1 / 60.0},
};

LogColumn column_named(std::string_view name) {
  LogColumn out;
  out.name = std::string(name);
  const std::string low = table::lower(name);
  if (const auto factor = table::time_factor(name)) {
    out.quantity = Quantity::time;
    out.factor = *factor;
    return out;
  }
  if (const auto* found = std::ranges::find(kNamed, low, &Named::name); found != kNamed.end()) {
    out.quantity = found->quantity;
    out.factor = found->factor;
    return out;
  }
  for (const Unit& unit : kUnits) {
    if (low.size() > unit.ending.size() && low.ends_with(unit.ending)) {
      out.quantity = unit.quantity;
      out.factor = unit.factor;
      out.offset = unit.offset;
      return out;
    }
  }
  return out;
}

/// An absent value, as loggers write it. Anything else that is not a number is a fault of the row,
/// not a missing reading.
bool absent(std::string_view field) {
  const std::string low = table::lower(field);
  return low.empty() || low == "nan" || low == "-" || low == "null" || low == "na" || low == "n/a";
}

class TableReader final : public table::Sink {
 public:
  explicit TableReader(const table::Format& format) : format_(format) {}

  // One time, one speed, at least one displacement; any number of temperatures.
  std::optional<Fault> head(const table::Head& head) override {
    out_.head_line = head.line;
    for (const std::string& name : head.name) {
      all_.push_back(column_named(name));
    }
    if (auto fault = find_clock(head)) {
      return fault;
    }
    for (const auto& [quantity, what, to_do] :
         {Needed{Quantity::speed, "the spindle's speed", "name one column spindle_rpm"},
          Needed{Quantity::displacement, "a displacement",
                 "name the displacements with their units: ch1_um, z_um, x_mm"}}) {
      const auto count = std::ranges::count(all_, quantity, &LogColumn::quantity);
      if (count == 0 || (count > 1 && quantity != Quantity::displacement)) {
        return wrong_number(count, what, to_do);
      }
    }
    return head.twice();
  }

  std::optional<Fault> row(const table::Row& row) override {
    for (std::size_t i = 0; i < row.size(); ++i) {
      LogColumn& column = all_[i];
      if (column.quantity == Quantity::other || (column.quantity == Quantity::time && i == time_)) {
        continue;
      }
      double value = std::numeric_limits<double>::quiet_NaN();
      // Absent is NaN from here on; whether a channel may have holes is decided later, by its
      // quantity.
      if (!absent(row.field(i))) {
        const auto number = row.number(i);
        if (!number) {
          return number.error();
        }
        value = *number;
      }
      // Converted here, once; NaN passes through.
      column.value.push_back(column.factor * value + column.offset);
    }
    const auto t_s = clock_->seconds(row);
    if (!t_s) {
      return t_s.error();
    }
    all_[time_].value.push_back(*t_s);
    out_.line.push_back(row.line());
    return std::nullopt;
  }

  LogTable take() {
    for (LogColumn& column : all_) {
      if (column.quantity != Quantity::other) {
        out_.column.push_back(std::move(column));
      } else if (!column.name.empty()) {
        out_.passed_over.push_back(column.name);
      }
    }
    return std::move(out_);
  }

 private:
  struct Needed {
    Quantity quantity;
    std::string_view what;
    std::string_view to_do;
  };

  static Fault wrong_number(std::ptrdiff_t count, std::string_view what, std::string_view to_do) {
    return {0,
            count == 0 ? fmt::format("the header has no column for {}", what)
                       : fmt::format("the header has {} columns for {}", count, what),
            std::string(to_do)};
  }

  /// One column with a known name, or another source of a row's time.
  std::optional<Fault> find_clock(const table::Head& head) {
    const auto count = std::ranges::count(all_, Quantity::time, &LogColumn::quantity);
    clock_ = table::Clock::of(head, format_, table::Epoch::unix);
    if (count > 1 || !clock_) {
      return wrong_number(count, "a time",
                          "name one column time_s (or t_s, time_min), or give stamps as "
                          "2026-11-22T23:47:06");
    }
    // The time may come from elsewhere than one column; the log still has one for it.
    if (!clock_->column()) {  // the rows themselves
      all_.emplace_back();
      all_.back().name = "row";
    }
    time_ = clock_->column().value_or(all_.size() - 1);
    out_.stamped = clock_->dated();
    all_[time_].quantity = Quantity::time;
    if (head.clocked && clock_->column() == head.clocked) {
      all_[*head.stamped].name.clear();  // read with the time of day
    }
    return std::nullopt;
  }

  const table::Format& format_;
  std::vector<LogColumn> all_;
  std::size_t time_ = 0;
  std::optional<table::Clock> clock_;
  LogTable out_;
};

}  // namespace

Result<LogTable> parse_log_table(std::string_view text, const std::string& file,
                                 const table::Format& format) {
  const auto refuse = [&](const Fault& fault) {
    return kernel::outcome::refuse(file, fault.line, fault.what, fault.to_do);
  };
  TableReader table(format);
  table::RowReader rows(format, table);
  if (const auto fault = table::read_rows(text, rows)) {
    return refuse(*fault);
  }
  if (!rows.has_head()) {
    return refuse({0, "the log is empty", "give a CSV with a header and rows"});
  }
  LogTable out = table.take();
  out.notes = rows.notes();
  return out;
}

}  // namespace steadyrest::thermal::offline
