// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/apps/cut/comparison.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cut {
namespace {

using kernel::machine::ContourStrategy;
using kernel::units::um_from_mm;

constexpr std::size_t kWorstLines = 20;
constexpr std::size_t kLongestText = 120;

std::string name_of(ContourStrategy strategy) {
  switch (strategy) {
    case ContourStrategy::contour_priority:
      return "contour priority";
    case ContourStrategy::feed_priority:
      return "feed priority";
    case ContourStrategy::combined:
      return "combined";
  }
  return "";
}

report::TracePoint point_of(const Sample& sample) {
  return {.time_s = sample.time_s,
          .path_mm = sample.path_position_mm,
          .position_mm = sample.position_mm,
          .contour_error_um = um_from_mm(sample.contour_error_mm),
          .tracking_error_um = um_from_mm(sample.tracking_error_mm),
          .override_percent = kernel::units::percent_from_ratio(sample.feed_ratio),
          .feed_mm_min = kernel::units::mm_min_from_mm_s(sample.path_speed_mm_s),
          .line = sample.line,
          .cutting = sample.motion == kernel::signal::Motion::feed};
}

report::Run run_of(const Recorder& record) {
  report::Run run{.figures = record.figures(), .trace = {}, .reasons = {}};
  for (const Sample& sample : record.trace()) {
    run.trace.push_back(point_of(sample));
  }
  for (const auto& [reason, seconds] : record.time_by_reason()) {
    run.reasons.push_back({reason, seconds});
  }
  if (record.vibration()) {
    run.vibration = record.vibration()->figures();
    run.vibration_course = record.vibration()->course();
  }
  return run;
}

std::vector<report::WorstLine> worst_lines(const Recorder& without, const Recorder& with) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::map<std::uint32_t, report::WorstLine> by_line;
  for (const LineError& error : without.line_errors()) {
    by_line[error.line] = {error.line, "", um_from_mm(error.contour_error_mm), kNone};
  }
  for (const LineError& error : with.line_errors()) {
    auto [entry, added] = by_line.try_emplace(error.line);
    if (added) {
      entry->second = {error.line, "", kNone, kNone};
    }
    entry->second.with_um = um_from_mm(error.contour_error_mm);
  }
  std::vector<report::WorstLine> lines;
  lines.reserve(by_line.size());
  for (const auto& [line, entry] : by_line) {
    lines.push_back(entry);
  }
  const auto size = [](const report::WorstLine& line) {
    return std::fmax(std::abs(line.without_um), std::abs(line.with_um));
  };
  std::ranges::sort(lines, [&](const auto& a, const auto& b) {
    return size(a) != size(b) ? size(a) > size(b) : a.line < b.line;
  });
  lines.resize(std::min(lines.size(), kWorstLines));
  return lines;
}

void add_texts(const std::filesystem::path& program, std::vector<report::WorstLine>& lines) {
  std::ifstream file(program, std::ios::binary);
  std::string text;
  for (std::uint32_t number = 1; std::getline(file, text); ++number) {
    const auto entry = std::ranges::find(lines, number, &report::WorstLine::line);
    if (entry == lines.end()) {
      continue;
    }
    if (!text.empty() && text.back() == '\r') {
      text.pop_back();
    }
    entry->text = text.substr(0, kLongestText);
  }
}

}  // namespace

report::ReportData compare(const std::filesystem::path& program,
                           const kernel::machine::Machine& machine, const Recorder& without,
                           const Recorder& with) {
  report::ReportData data;
  data.program = program.filename().string();
  data.machine = machine.name;
  data.strategy = name_of(machine.contour.strategy);
  data.limit_um = um_from_mm(machine.contour.limit_mm);
  const auto& table = machine.feed_override;
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    data.override_table.push_back({i < table.code.size() ? table.code[i] : 0,
                                   kernel::units::percent_from_ratio(table.ratio[i])});
  }
  data.without = run_of(without);
  data.with = run_of(with);
  data.worst_lines = worst_lines(without, with);
  add_texts(program, data.worst_lines);
  data.motion = with.motion();
  data.probes = with.probes();
  return data;
}

}  // namespace steadyrest::apps::cut
