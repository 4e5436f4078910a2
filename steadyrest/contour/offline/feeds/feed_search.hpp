// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/feeds/feed_cells.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::contour::offline {

/// What one cell shows in a run; single precision, since there are many.
struct CellRun {
  float seconds = 0.0F;
  float waiting_s = 0.0F;   ///< of them: dwells and waits before the cell
  float speed_mm_s = 0.0F;  ///< highest
  float error_mm = 0.0F;    ///< largest contour error while the command is in the cell …
  float of_feed_mm = 0.0F;  ///< … less what a rapid before has left
};

/// Looks for the fastest feeds that keep a limit, by running the path on the servo model again and
/// again.
///
/// Law. The tool at a place shows the speeds of the last few 1/k seconds, so each cell answers for
/// the largest error ε within `kReach`/k after the command has left it. On an arc ε ∝ v²; so
///   v ← v·√(limit/ε),   between `floor_ratio`·F and F.
/// A cell that was too fast never becomes that fast again: its ceiling falls, and the search ends.
/// What a rapid before the cut leaves is no feed's fault: e·exp(−k·t), e its lag along the path, t
/// the time since, is subtracted from ε.
/// Cells of one group have one feed; there a cell counts only where the feed is what limits the
/// speed, or where its error is too large.
class FeedSearch {
 public:
  struct Config {
    double limit_mm = 0.01;
    double floor_ratio = 0.1;
  };

  /// All of them must outlive it.
  FeedSearch(const kernel::machine::Machine& machine, FeedCells& cells,
             const nc::plan::PlannedPath& original, const ServoModels& models,
             const Config& config);

  /// Runs the path with the present feeds. Seconds of the whole program.
  [[nodiscard]] kernel::outcome::Result<double> measure();
  /// One step of the law. `settle`: ceilings fall.
  void adjust(bool settle);
  /// By cell, ascending; ceilings are lifted.
  void set_groups(std::vector<std::uint32_t> group);
  /// Another limit for the cells of a segment.
  void set_limit(std::size_t segment, double limit_mm);
  /// No error is above the limit that a lower feed could bring down.
  [[nodiscard]] bool keeps_limit() const noexcept;

  [[nodiscard]] const std::vector<CellRun>& runs() const noexcept { return run_; }
  [[nodiscard]] const std::vector<double>& ratio() const noexcept { return ratio_; }
  [[nodiscard]] const std::vector<std::uint32_t>& group() const noexcept { return group_; }
  [[nodiscard]] double limit_mm(std::size_t cell) const noexcept {
    return static_cast<double>(limit_mm_[cell]);
  }
  void set_ratios(std::vector<double> ratio);
  /// The share of its feed that a cell reaches.
  [[nodiscard]] double used_share(std::size_t cell) const noexcept;

 private:
  static constexpr double kReach = 2.0;

  void look_ahead();
  void choose(std::size_t first, std::size_t end, bool settle);

  const kernel::machine::Machine& machine_;
  FeedCells& cells_;
  const nc::plan::PlannedPath& original_;
  ServoModels models_;
  Config config_;
  std::vector<CellRun> run_;
  std::vector<float> limit_mm_;
  std::vector<float> worst_;  ///< largest ε/limit that the cell answers for
  std::vector<std::uint32_t> group_;
  std::vector<double> ratio_;
  std::vector<double> ceiling_ratio_;
};

}  // namespace steadyrest::contour::offline
