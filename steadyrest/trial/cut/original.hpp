// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::trial::cut {

/// The path that the part should have, where a changed program is cut, and which place of it each
/// place of the changed program belongs to (path_pairing.hpp).
struct Original {
  /// The search's window beside the servo lag is at most 10 mm.
  static constexpr double kWidestTube_mm = 5.0;

  std::shared_ptr<const nc::plan::PlannedPath> path;    ///< of the original, as it is programmed
  std::shared_ptr<const nc::plan::PlannedPath> as_cut;  ///< as the control plans the original
  math::geometry::PathPairing pairing;
  double tube_mm = 0.0;
  double farthest_mm = 0.0;  ///< of the changed path from the original, while both cut
  std::uint32_t changed_line = 0;
  std::uint32_t original_line = 0;  ///< there

  /// `original` as the control plans it; neither path is empty. Refuses programs that part by more
  /// than `tube_mm` while they cut, with the lines of both.
  static kernel::outcome::Result<Original> make(
      const nc::plan::PlannedPath& changed, std::shared_ptr<const nc::plan::PlannedPath> original,
      double tube_mm);
  /// What a path is judged by whose program gives a tolerance: itself as it is programmed. Null: it
  /// gives none, or one so wide that the two cannot be paired.
  static std::shared_ptr<const Original> of_itself(
      const std::shared_ptr<const nc::plan::PlannedPath>& path);
};

}  // namespace steadyrest::trial::cut
