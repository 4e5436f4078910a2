// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <steadyrest/apps/cli/machine/servo_capture.hpp>
#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::cli {
namespace servo_capture_reader {
namespace {

using contour::offline::ServoLog;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using Signals = std::map<std::string, std::size_t>;  // address → column

constexpr const char* kRecordAgain =
    "record DES_POS|n and ENC_POS|n of each axis, or take the axis out with --axes";

double to_inner(const kernel::machine::Axis& axis) {
  return axis.rotary ? std::numbers::pi / 180.0 : 1.0;
}

/// Columns of command and actual position in HFData.
struct Pair {
  std::size_t command = 0;
  std::size_t actual = 0;
};

std::optional<std::size_t> first_of(const Signals& signals, int number,
                                    std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto found = signals.find(fmt::format("{}|{}", name, number));
    if (found != signals.end()) {
      return found->second;
    }
  }
  return std::nullopt;
}

struct CaptureHead {
  Signals signals;
  std::vector<RecordedAxis> axes;
  double cycle_s = 0.0;
};

Result<CaptureHead> head_of(const std::string& file, const nlohmann::ordered_json& root) {
  CaptureHead out;
  const auto& head = root.value("Header", nlohmann::ordered_json::object());
  const auto& list = head.value("SignalListHFData", nlohmann::ordered_json::array());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string address = list[i].value("Address", std::string());
    out.signals.emplace(address, i);
    int number = 0;
    const std::size_t bar = address.find('|');
    if (address.starts_with("DES_POS|") &&
        std::from_chars(address.data() + bar + 1, address.data() + address.size(), number).ec ==
            std::errc()) {
      out.axes.push_back({number, list[i].value("Axis", std::string())});
    }
  }
  out.cycle_s = 1e-3 * head.value("CycleTimeMs", 0.0);
  if (!out.signals.contains("CYCLE") || out.cycle_s <= 0.0 || out.axes.empty()) {
    return refuse(file,
                  fmt::format("is JSON, but not a capture of SINUMERIK Edge with positions: {} is "
                              "missing in its Header",
                              out.axes.empty()                 ? "DES_POS|n"
                              : !out.signals.contains("CYCLE") ? "CYCLE"
                                                               : "CycleTimeMs"),
                  kRecordAgain);
  }
  return out;
}

Result<std::vector<Pair>> pairs_of(const std::string& file, const ServoSource& source,
                                   const CaptureHead& head) {
  const auto numbers = numbers_of(file, source, head.axes);
  if (!numbers) {
    return std::unexpected(numbers.error());
  }
  std::vector<Pair> out;
  for (const int number : *numbers) {
    const auto command = first_of(head.signals, number, {"DES_POS"});
    const auto actual = first_of(head.signals, number, {"ENC_POS", "ENC1_POS", "ENC2_POS"});
    if (!command || !actual) {
      return refuse(file,
                    fmt::format("{}|{} was not recorded", command ? "ENC_POS" : "DES_POS", number),
                    kRecordAgain);
    }
    out.push_back({*command, *actual});
  }
  return out;
}

/// Adds a row; false where it is none.
bool add_row(const nlohmann::ordered_json& row, const std::vector<Pair>& pairs,
             std::size_t cycle_column, double cycle_s, const ServoSource& source,
             std::vector<ServoLog>& logs, std::optional<double>& first) {
  const auto number = [&](std::size_t column) {
    return column < row.size() && row[column].is_number() ? std::optional(row[column].get<double>())
                                                          : std::nullopt;
  };
  const auto cycle = row.is_array() ? number(cycle_column) : std::nullopt;
  if (!cycle) {
    return false;
  }
  first = first ? first : cycle;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto command = number(pairs[i].command);
    const auto actual = number(pairs[i].actual);
    if (!command || !actual) {
      return false;
    }
    const double unit = to_inner(source.machine.axes[source.places[i]]);
    logs[i].time_s.push_back((*cycle - *first) * cycle_s);
    logs[i].command.push_back(unit * *command);
    logs[i].actual.push_back(unit * *actual);
  }
  return true;
}

}  // namespace
}  // namespace servo_capture_reader

kernel::outcome::Result<std::vector<int>> numbers_of(const std::string& file,
                                                     const ServoSource& source,
                                                     const std::vector<RecordedAxis>& recorded) {
  using kernel::outcome::refuse;
  std::map<std::string, int> given;
  for (const std::string& entry : source.options.columns) {
    const std::size_t equals = entry.find('=');
    int number = 0;
    if (equals == std::string::npos ||
        std::from_chars(entry.data() + equals + 1, entry.data() + entry.size(), number).ec !=
            std::errc()) {
      return refuse(fmt::format("--columns {}: {} has its own columns", entry, file),
                    "give the numbers of its axes, as --columns X=1,Y=2,Z=4, or leave --columns "
                    "out");
    }
    given[entry.substr(0, equals)] = number;
  }
  std::vector<std::string> all;
  all.reserve(recorded.size());
  for (const RecordedAxis& one : recorded) {
    all.push_back(one.name.empty() ? std::to_string(one.number)
                                   : fmt::format("{} ({})", one.number, one.name));
  }
  std::vector<int> out;
  for (const std::size_t place : source.places) {
    const std::string& name = source.machine.axes[place].name;
    const auto named = std::ranges::find_if(recorded, [&](const RecordedAxis& one) {
      return one.name == name || one.name == name + "1";
    });
    const int number = given.contains(name)      ? given[name]
                       : named != recorded.end() ? named->number
                                                 : static_cast<int>(place) + 1;
    if (std::ranges::find(recorded, number, &RecordedAxis::number) == recorded.end()) {
      return refuse(file,
                    fmt::format("axis {}: no positions of machine axis {}; recorded are {}", name,
                                number, fmt::join(all, ", ")),
                    fmt::format("say which it is, as --columns {}={}", name,
                                recorded.empty() ? 1 : recorded.front().number));
    }
    out.push_back(number);
  }
  return out;
}

kernel::outcome::Result<RecordedServos> servo_capture(const std::string& file,
                                                      std::string_view text,
                                                      const ServoSource& source) {
  using kernel::outcome::refuse;
  using servo_capture_reader::add_row;
  using servo_capture_reader::head_of;
  using servo_capture_reader::pairs_of;
  const auto root = kernel::file::json_object(text);
  if (!root) {
    const auto fault = kernel::file::json_fault(text);
    return refuse(file, fault ? fault->line : 1,
                  fault ? fault->what : "is JSON, but not a capture of SINUMERIK Edge",
                  "copy the file again, or record again");
  }
  const auto head = head_of(file, *root);
  if (!head) {
    return std::unexpected(head.error());
  }
  const auto pairs = pairs_of(file, source, *head);
  if (!pairs) {
    return std::unexpected(pairs.error());
  }
  RecordedServos out{std::vector<contour::offline::ServoLog>(pairs->size()), {}};
  std::optional<double> first;
  std::size_t rows = 0;
  const std::size_t cycle = head->signals.at("CYCLE");
  for (const auto& part : root->value("Payload", nlohmann::ordered_json::array())) {
    const auto data = part.find("HFData");
    if (data == part.end()) {
      continue;
    }
    for (const auto& row : *data) {
      ++rows;
      if (!add_row(row, *pairs, cycle, head->cycle_s, source, out.logs, first)) {
        return refuse(file, fmt::format("row {} of HFData has no number for every position", rows),
                      "copy the file again, or record again");
      }
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
