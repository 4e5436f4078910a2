// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;

Result<nc::plan::PlannedPath> plan_of(const std::string& program, const Lessons& lessons) {
  nc::plan::PathBuilder builder(lessons.machine);
  const auto report = nc::interpret::run_file(program, lessons.config, builder);
  if (!report) {
    return std::unexpected(report.error());
  }
  if (!report->refused.empty()) {
    return std::unexpected(nc::interpret::first_refusal(*report, program));
  }
  return builder.take();
}

}  // namespace

Result<LearntFrom> learn_from(const std::vector<CutPart>& parts, const Lessons& lessons) {
  LearntFrom out;
  for (const CutPart& part : parts) {
    const auto cut = plan_of(part.program, lessons);
    if (!cut) {
      return std::unexpected(cut.error());
    }
    LearnConfig config;
    config.uncertainty.gain_share = lessons.gain_uncertainty;
    auto figures = learn({.machine = lessons.machine,
                          .original = lessons.original,
                          .cut = *cut,
                          .record = part.record,
                          .model = lessons.model},
                         config, out.learnt);
    if (!figures) {
      kernel::outcome::Refusal refusal = figures.error();
      if (refusal.file.empty()) {
        refusal.file = part.program;
      }
      return std::unexpected(std::move(refusal));
    }
    out.figures.push_back(std::move(*figures));
  }
  return out;
}

}  // namespace steadyrest::contour::offline
