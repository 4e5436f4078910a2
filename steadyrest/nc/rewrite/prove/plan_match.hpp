// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {

/// A place of the changed program at which the correction of one axis becomes another.
struct WrittenChange {
  std::uint32_t line = 0;
  double stands_mm = 0.0;  ///< from there on
  double unit_mm = 1.0;
  double time_s = 0.0;  ///< of the original, when the machine gets there
};

struct Mismatch {
  std::uint32_t line = 0;  ///< 0: of no line
  std::string what;
};

/// Whether the changes written for one axis are the plan's, all of them and no other.
///
/// The steps in their order are cut into groups. A group answers to a change: it lasts until the
/// correction that is written there, and each of its steps is planned within the window of the
/// change. Or it answers to nothing: after it stands what stood before it, because its steps cancel
/// or are less than the control can take, and one instant lies within the window of them all.
/// The work is the number of steps times the number of changes.
[[nodiscard]] std::optional<Mismatch> mismatch(const AxisPlan& axis, const Settings& settings,
                                               const std::vector<WrittenChange>& changes);

}  // namespace steadyrest::nc::rewrite
