// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/trial/cut/recorder.hpp>

/// What `cut` answers, as JSON and as text.
namespace steadyrest::apps::cli::cut {

[[nodiscard]] Json json_of(const trial::cut::Figures& figures);
[[nodiscard]] Json json_of(const std::vector<trial::cut::MotionFigures>& motion);
[[nodiscard]] Json json_of(const std::vector<trial::cut::ProbeFigures>& probes);

/// One cut in the table.
struct Column {
  std::string head;
  trial::cut::Figures figures;
};
[[nodiscard]] std::string text_of(const std::vector<Column>& cuts, double limit_mm);
[[nodiscard]] std::string text_of(const std::vector<trial::cut::MotionFigures>& motion,
                                  const kernel::machine::Machine& machine);
[[nodiscard]] std::string text_of(const std::vector<trial::cut::ProbeFigures>& probes);

/// The key `withdrawn`; returns its text.
[[nodiscard]] std::string put_withdrawn(Answer& answer, const trial::cut::Recorder& with);

}  // namespace steadyrest::apps::cli::cut
