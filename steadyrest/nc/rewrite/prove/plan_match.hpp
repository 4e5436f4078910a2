// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {

/// A place in the changed program where the correction of one axis changes.
struct WrittenChange {
  std::uint32_t line = 0;
  double stands_mm = 0.0;  ///< from there on
  double unit_mm = 1.0;
  double time_s = 0.0;  ///< when the machine gets there in the original
};

struct Mismatch {
  std::uint32_t line = 0;  ///< 0: no line
  std::string what;
};

/// Whether the changes written for one axis are exactly the plan's.
///
/// The ordered steps are divided into groups. A group may match a change: it ends with the
/// correction written there, and all its steps are planned within the change's window. Or it
/// matches nothing: it leaves the correction unchanged, because its steps cancel or are below the
/// control's increment, and one instant lies within all their windows. The cost is the number of
/// steps times the number of changes.
[[nodiscard]] std::optional<Mismatch> mismatch(const AxisPlan& axis, const Settings& settings,
                                               const std::vector<WrittenChange>& changes);

}  // namespace steadyrest::nc::rewrite
