// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/depth/depth_tracker.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// ln ρ over the depth of cut at one speed, by the fastest method that is exact for the process.
///
/// Even pitch, constant speed, no process damping: DepthTracker, with helix only for one mode (with
/// several it gains nothing, since each depth has its own matrices). Otherwise the DelayCycle,
/// built once for all depths, or with helix, where the engagement depends on the depth, once per
/// depth.
namespace steadyrest::chatter::offline {

class DepthLine {
 public:
  /// Refuses what DelayCycle refuses, a process without modes, a speed or depth not above 0, an RVA
  /// outside 0 … 1 and an RVF not above 0.
  static kernel::outcome::Result<DepthLine> make(const Process& process, double speed_rev_s,
                                                 const Modulation& modulation,
                                                 double most_depth_mm);

  /// ln ρ over one period of the modulation law, over one pass (tooth pitch; revolution where the
  /// pitch is uneven) when constant. 0 ≤ depth ≤ most_depth_mm; quickest with rising depths.
  [[nodiscard]] double log_radius(double depth_mm);

  [[nodiscard]] const Process& process() const noexcept { return process_; }

  /// Uses DepthTracker: a depth costs some tens of microseconds.
  [[nodiscard]] bool quick() const noexcept { return tracker_ != nullptr; }
  /// The cost of a depth where it is not quick: size of the state times passes of the period.
  [[nodiscard]] std::size_t work() const noexcept { return work_; }

  /// The crossing of ρ = 1 between a stable and an unstable depth, to 1e-10 of the depth.
  [[nodiscard]] double crossing_mm(double stable_mm, double log_stable, double unstable_mm,
                                   double log_unstable);

 private:
  DepthLine() = default;

  Process process_;
  DelayCycle::Config config_;
  double free_log_radius_ = 0.0;  ///< at depth 0
  std::size_t work_ = 0;
  std::unique_ptr<DepthTracker> tracker_;
  std::unique_ptr<DelayCycle> cycle_;  ///< empty with helix
};

}  // namespace steadyrest::chatter::offline
