// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/contour/offline/learn/learn.hpp>
#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>

namespace steadyrest::contour::offline {

/// A part that was cut and recorded.
struct CutPart {
  PartRecord record;
  std::string program;  ///< the file that the control ran: the original or a changed one
};

/// What is the same for all parts.
struct Lessons {
  const kernel::machine::Machine& machine;
  const nc::interpret::Config& config;
  const nc::plan::PlannedPath& original;
  ServoModels model;
  double gain_uncertainty = 0.05;
};

struct LearntFrom {
  Learnt learnt;
  std::vector<LearningFigures> figures;  ///< of each part
};

/// Plans each part's program as the control did and learns from its record (learn.hpp); where
/// several parts teach the same place, their mean counts. Refused: what the interpreter, the
/// planner or learn() refuses.
[[nodiscard]] kernel::outcome::Result<LearntFrom> learn_from(const std::vector<CutPart>& parts,
                                                             const Lessons& lessons);

}  // namespace steadyrest::contour::offline
