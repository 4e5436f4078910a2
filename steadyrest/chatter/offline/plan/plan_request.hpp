// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <steadyrest/chatter/offline/plan/planner.hpp>

/// Requests to plan(): whether they can be answered, and what the answer leaves out.
namespace steadyrest::chatter::offline {

inline constexpr double kFastestPlanRvf = 0.5;   ///< of the laws tried
inline constexpr double kSlowestPlanRvf = 5e-4;  ///< near the solver's limit

/// Limit depths are searched up to here.
[[nodiscard]] double most_depth_mm(double depth_mm, const PlanOptions& options) noexcept;

[[nodiscard]] std::optional<kernel::outcome::Refusal> fault_of_request(const Process& process,
                                                                       double speed_rev_s,
                                                                       double depth_mm,
                                                                       const PlanOptions& options);

/// A note where many waves lie between two teeth and the process has no process damping: the flank
/// then rubs on short waves, so deeper cuts than the plan's are stable. Altintas, Eynian, Onozuka,
/// CIRP Annals 57 (2008) 371: from about ten waves on.
[[nodiscard]] std::optional<std::string> process_damping_ignored(const Process& process,
                                                                 double speed_rev_s);

}  // namespace steadyrest::chatter::offline
