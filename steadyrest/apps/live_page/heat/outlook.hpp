// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/apps/live_page/heat/corrections.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/tap.hpp>

namespace steadyrest::apps::live_page {

/// What the machine did for a while, as means.
struct Stretch {
  double seconds = 0.0;
  double speed_rev_s = 0.0;
  double feed_mm_s = 0.0;
  double cut_share = 0.0;
  double coolant_share = 0.0;
};

/// What heat and the offsets against it will do.
struct Outlook {
  struct Axis {
    std::size_t index = 0;  ///< among the machine's
    std::vector<double> displacement_mm;
    std::vector<double> sd_mm;
    std::vector<double> offset_mm;
  };
  double again_s = 0.0;             ///< length of what is repeated; 0: the present state lasts
  std::vector<double> in_s;         ///< from now on, a minute apart
  std::vector<Axis> axis;           ///< those with a thermal passport
  std::vector<Correction> to_come;  ///< from_s and to_s from now on
};

/// Runs a copy of the thermal room and of its envelope on for `seconds`, in steps of 1 s: the law
/// of model, wish, slope and limits is their own. The machine repeats `again`; without any it goes
/// on as it does. Temperatures stay. `corrects`: requests go somewhere (act, advise); otherwise the
/// offsets stay. Empty: the room is off or its passport unusable.
[[nodiscard]] std::optional<Outlook> outlook(const kernel::machine::Machine& machine,
                                             const steadyrest::live::HeatNow& now,
                                             std::span<const Stretch> again, bool corrects,
                                             const Corrections& done, double seconds);

}  // namespace steadyrest::apps::live_page
