// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>
#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// Waits between a rapid and the cut, where the tool still follows the rapid.
///
/// Law. When a rapid stops, the tool is behind it by e; e falls as exp(−k·t), and whatever the
/// command does, the first of the cut has it. So it waits for t = ln(ε/L)/k, ε the error as the cut
/// begins, L the limit, k the lowest gain. A run with these waits shows what is left, since
/// velocity loops have lags, and the control may wait for the spindle meanwhile: a wait that does
/// not keep the limit yet grows, by twice as much where the last addition has won little; after
/// four of these in a row it is taken back.
class RapidWaits {
 public:
  RapidWaits(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use, double limit_mm,
             double gain_1_s);

  /// By the errors that are left with the waits so far. False where nothing changes.
  [[nodiscard]] bool adjust(const std::vector<ErrorPlace>& over);
  [[nodiscard]] Waits waits() const;

 private:
  /// A cut from one rapid to the next.
  struct Start {
    std::uint32_t line = 0;
    double from_mm = 0.0;
    double to_mm = 0.0;
    double wait_s = 0.0;
    double error_mm = 0.0;  ///< before the last addition to the wait
    int in_vain = 0;        ///< additions that have won little, one after the other
    bool settled = false;
  };

  std::vector<Start> starts_;
  double limit_mm_;
  double gain_1_s_;
};

}  // namespace steadyrest::contour::offline
