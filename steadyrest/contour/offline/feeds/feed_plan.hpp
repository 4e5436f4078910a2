// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <steadyrest/contour/offline/feeds/feed_cells.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::contour::offline {

/// What is asked for.
struct FeedTask {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& path;      ///< that the control runs
  const nc::plan::PlannedPath& original;  ///< that the part should have
  const PathMap& map;                     ///< of the one to the other
  ServoModels model;
  FeedRoom room;
  double limit_mm = 0.01;     ///< of the contour error; > 0
  std::vector<double> start;  ///< by segment: the ratio that the search begins with; empty: 1
  bool rough = false;         ///< it will be searched again on another path
  double floor_ratio = 0.1;   ///< lowest feed, of the programmed one; above 0, at most 1
  double loss_share = 0.004;  ///< of the cycle time that fewer feeds may cost
  std::function<void(double share)> progress = [](double) {};  ///< of make()
};

/// A stretch of one segment with one feed.
struct FeedPart {
  std::uint32_t segment = 0;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double ratio = 1.0;  ///< of the segment's own feed
};

/// The fastest feeds that keep a limit of the contour error on the servo model, few enough to be
/// written.
///
/// First each cell (FeedCells) has its own feed, then neighbours are united (group_feeds) and their
/// common feeds are searched again (FeedSearch). Ten runs at most. The feeds are never above the
/// path's own; where not even `floor_ratio` keeps the limit, that is the feed.
class FeedPlan {
 public:
  /// Refused: limits out of range, and what run_model() refuses. The task's paths and machine must
  /// outlive it.
  [[nodiscard]] static kernel::outcome::Result<FeedPlan> make(const FeedTask& task);
  FeedPlan(FeedPlan&&) noexcept;
  ~FeedPlan();

  /// Searches again with other limits on these segments.
  [[nodiscard]] kernel::outcome::Result<void> tighten(
      const std::vector<std::pair<std::size_t, double>>& limit_mm);

  /// In order; of the segments whose feed may change.
  [[nodiscard]] std::vector<FeedPart> parts() const;
  [[nodiscard]] double seconds_before() const noexcept { return seconds_before_; }
  [[nodiscard]] double seconds() const noexcept { return seconds_; }
  /// No feed had to change.
  [[nodiscard]] bool unchanged() const noexcept { return unchanged_; }

 private:
  struct Parts;
  FeedPlan();
  [[nodiscard]] kernel::outcome::Result<void> search(int rounds);

  std::unique_ptr<Parts> of_;
  double seconds_before_ = 0.0;
  double seconds_ = 0.0;
  bool unchanged_ = false;
};

}  // namespace steadyrest::contour::offline
