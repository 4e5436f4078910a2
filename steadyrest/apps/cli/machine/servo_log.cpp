// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/servo_capture.hpp>
#include <steadyrest/apps/cli/machine/servo_log.hpp>
#include <steadyrest/apps/cli/machine/servo_table.hpp>
#include <steadyrest/kernel/file/memory_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/table/packed_file.hpp>

namespace steadyrest::apps::cli {
namespace servo_log {
namespace {

using contour::offline::ServoLog;
using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;

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

Result<RecordedServos> from_record(const std::string& file, const ServoSource& source,
                                   Progress& progress) {
  const Machine& machine = source.machine;
  const std::vector<std::size_t>& places = source.places;
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
bool is_record(const std::string& file) {
  std::error_code none;
  if (file.ends_with(".sqlite") || !std::filesystem::is_regular_file(file, none)) {
    return true;
  }
  std::ifstream in(file, std::ios::binary);
  std::array<char, 15> first{};
  in.read(first.data(), first.size());
  return std::string_view(first.data(), first.size()) == "SQLite format 3";
}

/// By the first character that is not blank; a byte order mark counts as blank.
char first_of(std::istream& in) {
  char out = ' ';
  while (in.get(out) &&
         (std::string_view(" \t\r\n\xEF\xBB\xBF").find(out) != std::string_view::npos)) {
  }
  in.clear();
  in.seekg(0);
  return out;
}

Result<RecordedServos> from_text(const std::string& file, const ServoSource& source,
                                 Progress& progress) {
  std::ifstream plain(file, std::ios::binary);
  const char first = first_of(plain);
  const bool packed = first == '\x1F';
  if (!packed && first != '{' && first != '<') {
    return servo_table(file, plain, source);
  }
  const auto text = table::read_packed(file);
  if (!text) {
    return std::unexpected(text.error());
  }
  if (text->starts_with("SQLite format 3")) {
    const auto unpacked = kernel::file::MemoryFile::make(*text);
    return unpacked ? from_record(unpacked->path(), source, progress)
                    : std::unexpected(unpacked.error());
  }
  std::istringstream in(*text);
  const char kind = packed ? first_of(in) : first;
  return kind == '{'   ? servo_capture(file, *text, source)
         : kind == '<' ? servo_trace(file, *text, source)
                       : servo_table(file, in, source);
}

}  // namespace
}  // namespace servo_log

kernel::outcome::Result<RecordedServos> read_servos(const std::string& file,
                                                    const ServoSource& source, Progress& progress) {
  auto out = servo_log::is_record(file) ? servo_log::from_record(file, source, progress)
                                        : servo_log::from_text(file, source, progress);
  if (out) {
    if (auto fit = servo_log::fit_for_use(file, *out); !fit) {
      return std::unexpected(fit.error());
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
