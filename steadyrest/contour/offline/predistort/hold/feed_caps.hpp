// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// An error that the path alone does not take away.
struct ErrorPlace {
  double foot_mm = 0.0;      ///< original path length that the tool is at
  double progress_mm = 0.0;  ///< … and the command
  double error_mm = 0.0;     ///< magnitude
  bool early = false;        ///< what comes before has left it: no feed here takes it away
  double since_s = 0.0;      ///< the cut began behind a pause
};

/// Lower feeds where a changed path alone does not keep a limit.
///
/// Law. An error ε at the tool comes from how the command moved between the tool's place and its
/// own, so all of that stretch runs at v·√(limit/ε), v the lowest speed of the command in it: at a
/// corner it is passed at one low speed, without braking and accelerating. Stretches that touch
/// are one. Never below `least_ratio` of the programmed feed.
///
/// A command that windows make better may brake and accelerate: for it the stretch falls from the
/// highest speed in it (Speed::highest), so that a stop does not slow down all of its block. On an
/// arc of radius R the command runs on R·√(1 + q²) at v·√(1 + q²), q = v·L/R: lower_arcs() takes
/// feeds that the control could not give it.
class FeedCaps {
 public:
  /// `path`, the original, must outlive it.
  FeedCaps(const nc::plan::PlannedPath& path, double least_ratio);

  /// Arcs on which the command would take more than `share` of the speed that the control permits.
  void lower_arcs(const nc::plan::PathLimits& limits, double lag_s, double share);

  /// Which speed of the command counts in a stretch.
  enum class Speed : std::uint8_t { lowest, highest };
  /// One step of the law. True when a feed has fallen.
  [[nodiscard]] bool tighten(const std::vector<ErrorPlace>& places, const CommandSpeed& speed,
                             double limit_mm, Speed which = Speed::lowest);
  /// That the feeds permit at this original path length.
  [[nodiscard]] double most_mm_s(double at_mm) const noexcept {
    return ratio_[cell(at_mm)] * feed_mm_s(at_mm);
  }

  /// The pieces with these feeds; a piece is divided where its feed changes.
  [[nodiscard]] std::vector<Piece> apply(std::vector<Piece> pieces) const;

 private:
  /// Where the feed is lowered.
  struct Stretch {
    double from_mm = 0.0;
    double to_mm = 0.0;
    double ratio = 1.0;
  };
  [[nodiscard]] std::size_t cell(double at_mm) const noexcept;
  [[nodiscard]] double feed_mm_s(double at_mm) const noexcept;
  void unite();

  const nc::plan::PlannedPath& path_;
  double least_ratio_;
  std::vector<double> ratio_;  ///< by cell
  std::vector<Stretch> stretches_;
};

}  // namespace steadyrest::contour::offline
