// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/packed_file.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Point;
using table::Fault;

constexpr std::size_t kLeastRows = 100;
constexpr std::array<std::string_view, 6> kColumns = {"x_cmd_mm", "y_cmd_mm", "z_cmd_mm",
                                                      "x_act_mm", "y_act_mm", "z_act_mm"};
constexpr std::string_view kWay =
    "give the columns t_s,x_cmd_mm,y_cmd_mm,z_cmd_mm,x_act_mm,y_act_mm,z_act_mm in machine "
    "coordinates";

class PartSink final : public table::Sink {
 public:
  explicit PartSink(const table::Format& format) : format_(format) {}

  std::optional<Fault> head(const table::Head& head) override {
    const auto missing = [](std::string_view name) {
      return Fault{0, fmt::format("the column {} is missing in the header", name),
                   std::string(kWay)};
    };
    if (auto fault = head.twice("t_s")) {
      return fault;
    }
    clock_ = table::Clock::of(head, format_);
    if (!clock_) {
      return missing("t_s");
    }
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      if (auto fault = head.twice(kColumns[i])) {
        return fault;
      }
      const auto place = head.place(kColumns[i]);
      if (!place) {
        return missing(kColumns[i]);
      }
      column_[i] = *place;
    }
    return std::nullopt;
  }

  std::optional<Fault> row(const table::Row& row) override {
    const auto t_s = clock_->seconds(row);
    if (!t_s) {
      return t_s.error();
    }
    if (!out_.time_s.empty() && !(*t_s > out_.time_s.back())) {
      return Fault{row.line(),
                   fmt::format("t_s = {:.6f} s does not rise; the row before has {:.6f} s", *t_s,
                               out_.time_s.back()),
                   "give one part as it was recorded, with enough digits of t_s"};
    }
    std::array<double, kColumns.size()> value{};
    for (std::size_t i = 0; i < value.size(); ++i) {
      const auto read = row.number(column_[i]);
      if (!read) {
        return read.error();
      }
      value[i] = *read;
    }
    out_.time_s.push_back(*t_s);
    out_.command_mm.push_back({value[0], value[1], value[2]});
    out_.actual_mm.push_back({value[3], value[4], value[5]});
    return std::nullopt;
  }

  [[nodiscard]] PartRecord take() { return std::move(out_); }

 private:
  const table::Format& format_;
  std::optional<table::Clock> clock_;
  std::array<std::size_t, kColumns.size()> column_{};
  PartRecord out_;
};

double median_step_s(const std::vector<double>& time_s) {
  std::vector<double> step(time_s.size() - 1);
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] = time_s[i + 1] - time_s[i];
  }
  const auto middle = step.begin() + static_cast<std::ptrdiff_t>(step.size() / 2);
  std::ranges::nth_element(step, middle);
  return *middle;
}

}  // namespace

Result<PartRecord> parse_part_record(std::string_view text, const std::string& file) {
  const table::Format format;
  PartSink sink(format);
  table::RowReader rows(format, sink);
  if (auto fault = table::read_rows(text, rows)) {
    return refuse(file, fault->line, fault->what, fault->to_do);
  }
  PartRecord record = sink.take();
  if (record.size() < kLeastRows) {
    return refuse(file,
                  fmt::format("holds {} rows; at least {} are needed", record.size(), kLeastRows),
                  "give the record of a whole part");
  }
  record.file = file;
  record.period_s = median_step_s(record.time_s);
  return record;
}

Result<PartRecord> read_part_record(const std::string& file) {
  const auto text = table::read_packed(file);
  if (!text) {
    return std::unexpected(text.error());
  }
  return parse_part_record(*text, file);
}

}  // namespace steadyrest::contour::offline
