// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>

namespace steadyrest::contour::offline {
using kernel::outcome::Result;

Result<LearntFrom> learn_from(const std::vector<CutPart>& parts, const Lessons& lessons) {
  LearntFrom out;
  for (const CutPart& part : parts) {
    const auto cut = nc::plan::plan_file(part.program, lessons.config, lessons.machine);
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
