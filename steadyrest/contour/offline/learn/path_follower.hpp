// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// Follows recorded commanded positions along the path that is said to have been cut: which path
/// length each of them is at.
///
/// Law. A command that moves by δ moves on by δ along the path, or a little more where the path
/// bends between two samples: the nearest place in [s + 0.9·δ − r, s + 1.1·δ + r], r = 0.01 mm +
/// 0.05·δ, is taken if it is within `near_mm`; else in [s, s + 2·δ + 5 mm]. So a path that runs
/// back along itself, or passes the same place again, does not mislead. A command that is on
/// neither is off the path. Then the path ahead is searched: the first place within `near_mm` is
/// taken and has to prove itself, by `kProof_mm` of path that the commands follow. The search is
/// repeated after 2, 4, 8 … 512 samples.
class PathFollower {
 public:
  static constexpr double kProof_mm = 2.0;

  PathFollower(kernel::signal::PathView path, double near_mm) noexcept
      : path_(path), near_mm_(near_mm) {}

  /// The path length of the next command; nothing while it is off the path.
  [[nodiscard]] std::optional<double> next(const kernel::signal::Point& command_mm);

 private:
  struct Nearest {
    double position_mm = 0.0;
    double distance_mm = 1e300;
  };
  [[nodiscard]] Nearest nearest(const kernel::signal::Point& point, double low_mm,
                                double high_mm) const noexcept;
  [[nodiscard]] bool find_ahead(const kernel::signal::Point& point) noexcept;
  [[nodiscard]] bool follow(const kernel::signal::Point& point, double moved_mm) noexcept;

  kernel::signal::PathView path_;
  double near_mm_;
  std::optional<kernel::signal::Point> last_mm_;
  double position_mm_ = 0.0;
  double proof_from_mm_ = 0.0;  ///< where it was found
  bool on_path_ = false;
  std::size_t wait_ = 0;  ///< samples until the next search
  std::size_t patience_ = 1;
};

}  // namespace steadyrest::contour::offline
