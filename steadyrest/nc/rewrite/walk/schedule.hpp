// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// A safe place that lies in the window of a planned instant.
struct Place {
  std::uint32_t line = 0;  ///< the correction goes before this line
  Site site = Site::none;
  double time_s = 0.0;
  double position_mm = 0.0;  ///< where the axis is, active work coordinates
  double unit_mm = 1.0;
  bool units_said = true;  ///< by the program, not by the control's state
  std::size_t active_offset = 0;
};

/// One planned step with the place that was chosen for it.
struct Chosen {
  Place place;
  PlannedStep step;
};

/// Chooses the places of one axis in one pass over the program: within the window the best kind of
/// place (rapid, clearance, feed), then the nearest, never before the previous step's. Holds six
/// places per step, whatever the program's length.
class Schedule {
 public:
  Schedule(AxisPlan plan, double window_s);

  /// Places come in the order of time.
  void offer(const Place& place);
  /// Refused when a step has no safe place within its window.
  [[nodiscard]] kernel::outcome::Result<std::vector<Chosen>> choose() const;
  [[nodiscard]] const AxisPlan& plan() const noexcept { return plan_; }

 private:
  static constexpr std::size_t kSites = 3;
  struct Nearest {
    std::optional<Place> before;
    std::optional<Place> behind;
  };
  using Near = std::array<Nearest, kSites>;

  [[nodiscard]] std::optional<Place> best(std::size_t step, std::uint32_t first_line) const;

  AxisPlan plan_;
  double window_s_;
  std::size_t first_ = 0;  ///< steps before it are past their window
  std::vector<Near> near_;
};

}  // namespace steadyrest::nc::rewrite
