// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/servo_inverse.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// How fast the command moves, by its progress: the corresponding original path length.
struct CommandSpeed {
  std::vector<double> progress_mm;  ///< ascending
  std::vector<double> speed_mm_s;

  void add(double progress, double speed) {
    if (progress_mm.empty() || progress > progress_mm.back() + 1e-9) {
      progress_mm.push_back(progress);
      speed_mm_s.push_back(speed);
    }
  }
};

/// One instant of the tool's motion.
struct ToolState {
  double position_mm = 0.0;  ///< path length s of the tool
  double speed_mm_s = 0.0;   ///< v
  double command_mm_s = 0.0;
  double progress_mm = 0.0;  ///< of the command: s + v·L
};

/// The motion of a tool that stays on the path while the command moves at a given speed.
///
/// Law: ServoInverse gives v̇ from v and the command's speed w; ṡ = v. The command is ahead by v·L,
/// L the largest lag, so w is taken at the progress s + v·L. v tends to its steady value with the
/// time constant L; each step of 0.1·L is exact for a steady value that does not change. On arcs
/// the tool is slower than the command, w = v·√(1 + q²), q = v·L/R.
class ToolMotion {
 public:
  ToolMotion(const ServoInverse& inverse, const nc::plan::PlannedPath& path,
             const CommandSpeed& command);

  [[nodiscard]] const std::vector<ToolState>& states() const noexcept { return states_; }
  /// The first state whose tool is at or behind this path length; size() when none is.
  [[nodiscard]] std::size_t from(double position_mm) const noexcept;
  /// Interpolated where the tool passes this path length.
  [[nodiscard]] ToolState at(double position_mm) const noexcept;

 private:
  std::vector<ToolState> states_;
};

}  // namespace steadyrest::contour::offline
