// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/machines.hpp>

/// Plans for a slot.
namespace steadyrest::chatter::offline::test {

using kernel::machine::Machine;

inline const Process kSlot = benchmark_cut(1.0, Direction::up);

inline Plan plan_at(const Machine& machine, double rpm, double depth_mm,
                    const PlanOptions& options = {}) {
  auto made = plan(kSlot, machine, rpm / 60.0, depth_mm, options);
  EXPECT_TRUE(made.has_value());
  return made.value_or(Plan{});
}

inline Machine all_steps() {
  return light_spindle({50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120});
}

/// The step into the pocket at 5500 rpm is missing.
inline Machine without_110() {
  return light_spindle({80, 85, 90, 95, 100, 105, 115, 120});
}

inline std::string all_reasons(const Plan& plan) {
  std::string out;
  for (const Alternative& a : plan.alternatives) {
    for (const std::string& reason : a.reasons) {
      out += reason + "\n";
    }
  }
  return out;
}

}  // namespace steadyrest::chatter::offline::test
