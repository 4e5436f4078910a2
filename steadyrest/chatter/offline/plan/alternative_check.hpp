// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/chatter/offline/plan/planner.hpp>

/// The planner's checks of one alternative. Internal to the planner.
namespace steadyrest::chatter::offline {

class AlternativeCheck {
 public:
  /// Refers to all three, which must outlive it.
  AlternativeCheck(const Process& process, const kernel::machine::Machine& machine,
                   double programmed_rev_s, double depth_mm, double most_depth_mm,
                   const PlanOptions& options);

  /// Checks everything about an override step. `demand` must be filled.
  void step(Alternative& alternative) const;
  /// Whether a law is stable with the given figures. ln ρ per pass; infinity: no principal period.
  [[nodiscard]] double log_radius(Alternative& law) const;
  /// Growth and probability of a stable law, the cheapest reason to reject it first.
  void judge(Alternative& law) const;
  /// Fills limit_depth_mm of a law, unless its period is too long; for a rejected law also unless
  /// many waves between two teeth make it too expensive.
  void limit(Alternative& law) const;
  /// The greatest depth up to the wanted one, to 1 %, that reaches the probability.
  [[nodiscard]] double likely_depth_mm(const Alternative& a) const;

 private:
  [[nodiscard]] double speed(const Alternative& a) const { return speed_rev_s_ * a.ratio; }
  [[nodiscard]] double probability(const Alternative& a, double depth_mm) const;
  void reject_unlikely(Alternative& a) const;
  void reject_unstable_as_written(Alternative& law) const;
  void reject_below_depth(Alternative& a) const;

  const Process* process_;
  const kernel::machine::Machine* machine_;
  double speed_rev_s_;
  double depth_mm_;
  double most_depth_mm_;
  const PlanOptions* options_;
  std::vector<Process> possible_;
};

}  // namespace steadyrest::chatter::offline
