// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>

/// What `chatter plan` answers, as keys and as words.
namespace steadyrest::apps::cli {

/// The cut that was planned.
struct PlannedCut {
  double speed_rpm = 0.0;  ///< programmed
  double depth_mm = 0.0;
};

[[nodiscard]] Json plan_json(const chatter::offline::Plan& plan, const PlannedCut& cut);
/// A constant speed reads as an override step, a law as amplitude and period in the units of the
/// drive.
[[nodiscard]] std::string plan_choice(const chatter::offline::Alternative& a, double speed_rpm);
/// The decision as an instruction to the operator.
[[nodiscard]] std::string plan_headline(const chatter::offline::Plan& plan, const PlannedCut& cut);

}  // namespace steadyrest::apps::cli
