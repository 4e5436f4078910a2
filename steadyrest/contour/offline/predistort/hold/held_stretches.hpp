// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <steadyrest/contour/offline/predistort/followed_run.hpp>
#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// The best command of each stretch between rapids and blocks that stay, of all that were run.
///
/// Law. Where a limit L is to be held, a stretch costs T + a·T₊ + b·∫ (ε/L)² − 1 dt: T its time, T₊
/// that with an error ε above L, the integral over T₊; what a rapid has left counts almost nothing,
/// since no command takes it away. Else it costs λ·T + ∫ (ε/L)² dt, as in the windows (ChainPrice).
/// One stretch hardly acts on the next, since a rapid lies between them.
class HeldStretches {
 public:
  enum class Price : std::uint8_t { over_limit, all_errors };
  HeldStretches(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use,
                double limit_mm, Price price = Price::over_limit);

  enum class By : std::uint8_t { feeds, windows };
  /// A run of these pieces; the stretches that are better than ever before keep theirs.
  /// `harmed_mm`: places of the original where some machine within the uncertainty gets worse:
  /// their stretches are dearer than any other.
  void note(const std::vector<Piece>& pieces, const FollowedRun& run,
            const std::vector<double>& harmed_mm, By by);
  /// The stretch at this path length takes its best by feeds. False where it has that already.
  bool give_up_windows(double at_mm);
  /// The best of all.
  [[nodiscard]] std::vector<Piece> best() const;
  /// These pieces where the stretch is open, else the best.
  [[nodiscard]] std::vector<Piece> with(const std::vector<Piece>& made) const;
  /// The pieces of open stretches.
  [[nodiscard]] std::vector<Piece> open(std::vector<Piece> pieces) const;
  /// Closes the stretches whose windows have left nothing, and gives the places that they have left
  /// elsewhere.
  [[nodiscard]] std::vector<ErrorPlace> close_good();
  /// Of the best, s.
  [[nodiscard]] double cost_s() const;
  /// Of the open stretches in the last run, s.
  [[nodiscard]] double open_cost_s() const noexcept { return open_cost_s_; }
  /// Of a whole run, s.
  [[nodiscard]] double cost_s(const FollowedRun& run) const;

 private:
  struct Stretch {
    double from_mm = 0.0;
    double to_mm = 0.0;
    kernel::signal::Point end_mm{};
    bool joined = false;  ///< it begins where the one before it ends
    bool open = true;
    double cost_s = std::numeric_limits<double>::infinity();
    std::vector<Piece> pieces;
    double feeds_s = std::numeric_limits<double>::infinity();  ///< of the best by feeds
    std::vector<Piece> by_feeds;
    bool given_up = false;
    double windows_s =
        std::numeric_limits<double>::infinity();  ///< the cost of the best by windows …
    std::vector<ErrorPlace> left;                 ///< … and what it leaves
  };
  [[nodiscard]] std::size_t of(double at_mm) const noexcept;
  [[nodiscard]] std::vector<double> costs_s(const FollowedRun& run) const;
  /// Where the tool is; what the axes bring along from before a stop costs the stretch before it,
  /// too.
  void charge(std::vector<double>& costs, double foot_mm, double cost_s) const;

  std::vector<Stretch> stretches_;
  double limit_mm_;
  Price price_;
  double open_cost_s_ = 0.0;
};

}  // namespace steadyrest::contour::offline
