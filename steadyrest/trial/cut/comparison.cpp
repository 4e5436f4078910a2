// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/comparison.hpp>
#include <steadyrest/trial/cut/worst_lines.hpp>

// From the two runs to the report's contents. Everyday units (µm, mm/min, %) are made here, at the
// border, and nowhere earlier.
namespace steadyrest::trial::cut {
namespace {

using kernel::machine::ContourStrategy;
using kernel::units::um_from_mm;

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

TracePoint point_of(const Sample& sample) {
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

}  // namespace

// One side of the comparison: figures, trace, and the time for each reason.
Run run_of(const Recorder& record) {
  Run run{.figures = record.figures(), .trace = {}, .reasons = {}};
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

// Includes the override table and the worst lines, so that a report explains itself.
ReportData compare(const std::filesystem::path& program, const kernel::machine::Machine& machine,
                   const Recorder& without, const Recorder& with) {
  ReportData data;
  data.program = program.filename().string();
  data.machine = machine.name;
  data.strategy = name_of(machine.contour.strategy);
  data.limit_um = um_from_mm(machine.contour.limit_mm);
  const auto& table = machine.feed_override;
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    // A binary table may have no codes.
    data.override_table.push_back({i < table.code.size() ? table.code[i] : 0,
                                   kernel::units::percent_from_ratio(table.ratio[i])});
  }
  data.without = run_of(without);
  data.with = run_of(with);
  data.worst_lines = worst_lines(program, machine, without, with);
  data.motion = with.motion();
  data.probes = with.probes();
  return data;
}

}  // namespace steadyrest::trial::cut
