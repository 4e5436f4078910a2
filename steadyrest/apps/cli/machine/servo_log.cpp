// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/servo_log.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::apps::cli {
namespace servo_log {
namespace {

using contour::offline::ServoLog;
using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using table::Fault;

constexpr const char* kOtherMachine = "give the machine file of the machine that was recorded";

void add(ServoLog& log, double time_s, double command, double actual) {
  log.time_s.push_back(time_s);
  log.command.push_back(command);
  log.actual.push_back(actual);
}

std::string names_of(const Machine& machine) {
  std::string out;
  for (const auto& axis : machine.axes) {
    out += axis.present ? axis.name : "-";
  }
  return out;
}

/// The record has its machine file in it: its axes must be this machine's.
Result<void> same_axes(const std::string& file, const std::string& recorded_text,
                       const Machine& machine) {
  if (recorded_text.empty()) {
    return {};
  }
  const auto recorded = passport::parse(recorded_text, file);
  if (recorded && names_of(*recorded) != names_of(machine)) {
    return refuse(file,
                  fmt::format("has the axes {}, the machine file has {}", names_of(*recorded),
                              names_of(machine)),
                  kOtherMachine);
  }
  return {};
}

Result<void> same_count(const std::string& file, std::size_t count, const Machine& machine) {
  if (count != machine.axes.size()) {
    return refuse(file,
                  fmt::format("has {} axes, the machine file has {}", count, machine.axes.size()),
                  kOtherMachine);
  }
  return {};
}

Result<RecordedServos> from_record(const std::string& file, const Machine& machine,
                                   const std::vector<std::size_t>& places, Progress& progress) {
  auto reader = record::RecordReader::open(file);
  if (!reader) {
    return std::unexpected(reader.error());
  }
  if (auto same = same_axes(file, reader->run().machine_text, machine); !same) {
    return std::unexpected(same.error());
  }
  RecordedServos out;
  out.date = reader->run().start_utc.substr(0, 10);
  out.logs.resize(places.size());
  const auto sample = std::make_unique<record::Sample>();
  for (std::uint64_t samples = 0;;) {
    const auto more = reader->next(*sample);
    if (!more) {
      return std::unexpected(more.error());
    }
    if (!*more) {
      return out;
    }
    const auto& frame = sample->frame;
    if (auto same = same_count(file, frame.axis_count, machine); !same) {
      return std::unexpected(same.error());
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      add(out.logs[i], frame.time_s, frame.axis.at(places[i]).command_mm,
          frame.axis.at(places[i]).actual_mm);
    }
    if (++samples % 4096 == 0) {
      progress.update(static_cast<double>(samples) /
                          static_cast<double>(std::max(reader->totals().samples, samples)),
                      "reading");
    }
  }
}

class ServoSink final : public table::Sink {
 public:
  ServoSink(const Machine& machine, const std::vector<std::size_t>& places)
      : machine_(machine), places_(places), logs_(places.size()) {}

  std::optional<Fault> head(const table::Head& head) override {
    if (auto fault = place(head, "time_s", time_)) {
      return fault;
    }
    axes_ = head.place("axis_count");
    for (const std::size_t axis : places_) {
      auto& columns = columns_.emplace_back();
      if (auto fault = place(head, fmt::format("axis.command_mm.{}", axis), columns[0])) {
        return fault;
      }
      if (auto fault = place(head, fmt::format("axis.actual_mm.{}", axis), columns[1])) {
        return fault;
      }
    }
    return std::nullopt;
  }

  std::optional<Fault> row(const table::Row& row) override {
    const auto time_s = row.number(time_);
    if (!time_s) {
      return time_s.error();
    }
    const auto axes = axes_ ? row.number(*axes_) : std::expected<double, Fault>(0.0);
    if (!axes) {
      return axes.error();
    }
    if (axes_ && *axes != static_cast<double>(machine_.axes.size())) {
      return Fault{row.line(),
                   fmt::format("has {} axes, the machine file has {}", *axes, machine_.axes.size()),
                   kOtherMachine};
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto command = row.number(columns_[i][0]);
      const auto actual = row.number(columns_[i][1]);
      if (!command || !actual) {
        return !command ? command.error() : actual.error();
      }
      add(logs_[i], *time_s, *command, *actual);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<ServoLog> take() { return std::move(logs_); }

 private:
  static std::optional<Fault> place(const table::Head& head, const std::string& name,
                                    std::size_t& out) {
    const auto found = head.place(name);
    if (!found) {
      return Fault{head.line, fmt::format("the column {} is missing in the header", name),
                   "give a record of a run, or the table that `record export` makes of one"};
    }
    out = *found;
    return head.twice(name);
  }

  const Machine& machine_;
  const std::vector<std::size_t>& places_;
  std::vector<ServoLog> logs_;
  std::size_t time_ = 0;
  std::optional<std::size_t> axes_;
  std::vector<std::array<std::size_t, 2>> columns_;
};

/// Line by line: a table of a run is large, and most of its columns are of no use here.
Result<RecordedServos> from_table(const std::string& file, const Machine& machine,
                                  const std::vector<std::size_t>& places) {
  ServoSink sink(machine, places);
  table::RowReader rows({}, sink);
  std::ifstream in(file, std::ios::binary);
  std::string line;
  std::optional<Fault> fault;
  while (!fault && std::getline(in, line)) {
    fault = rows.line(line);
  }
  if (in.bad()) {
    return refuse(file, "cannot be read to its end", "check the disk, or copy the file again");
  }
  if (!fault) {
    fault = rows.finish();
  }
  if (fault) {
    return refuse(file, fault->line, fault->what, fault->to_do);
  }
  return RecordedServos{sink.take(), {}};
}

/// Time must rise, and every position must be a number.
Result<void> fit_for_use(const std::string& file, const RecordedServos& servos) {
  for (const ServoLog& log : servos.logs) {
    if (log.time_s.size() < 2) {
      return refuse(file, fmt::format("holds {} samples", log.time_s.size()),
                    "give the record of a run in which the axes move");
    }
    for (std::size_t n = 0; n < log.time_s.size(); ++n) {
      if (!std::isfinite(log.command[n]) || !std::isfinite(log.actual[n]) ||
          !std::isfinite(log.time_s[n]) || (n > 0 && log.time_s[n] <= log.time_s[n - 1])) {
        return refuse(
            file,
            fmt::format("sample {}: the time does not rise, or a position is no number", n + 1),
            "give the record of one run as it was written");
      }
    }
  }
  return {};
}

/// What cannot be read, and what calls itself a record, the reader of records refuses by name.
bool is_table(const std::string& file) {
  std::error_code none;
  if (file.ends_with(".sqlite") || !std::filesystem::is_regular_file(file, none)) {
    return false;
  }
  std::ifstream in(file, std::ios::binary);
  std::array<char, 15> first{};
  in.read(first.data(), first.size());
  return std::string_view(first.data(), first.size()) != "SQLite format 3";
}

}  // namespace
}  // namespace servo_log

kernel::outcome::Result<RecordedServos> read_servos(const std::string& file,
                                                    const kernel::machine::Machine& machine,
                                                    const std::vector<std::size_t>& places,
                                                    Progress& progress) {
  auto out = servo_log::is_table(file) ? servo_log::from_table(file, machine, places)
                                       : servo_log::from_record(file, machine, places, progress);
  if (out) {
    if (auto fit = servo_log::fit_for_use(file, *out); !fit) {
      return std::unexpected(fit.error());
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
