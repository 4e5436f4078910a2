// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predistort/run_errors.hpp>
#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// Lines that stay after all, and why.
class BarredLines {
 public:
  /// `path` must outlive it.
  BarredLines(const nc::plan::PlannedPath& path, std::span<const kernel::machine::Axis> axes,
              double max_shift_mm)
      : path_(path), travel_(path, axes), max_shift_mm_(max_shift_mm) {}

  /// Bars the lines whose pieces go too far from the path, or past an end of the travel. True when
  /// there are any: the pieces must be made again.
  bool bar_beyond(const std::vector<Piece>& pieces) {
    const Shift shift = shift_of(path_, pieces, max_shift_mm_);
    const auto past = travel_.left_by(pieces);
    largest_shift_mm_ = shift.largest_mm;
    add(shift.too_far, too_far);
    add(past, past_travel);
    return !shift.too_far.empty() || !past.empty();
  }
  /// Bars runs whose error would grow. The lag carries what a run does into those behind it: where
  /// one is barred already, the nearest before it, else the one behind. True when any was not.
  bool bar_worse(const std::vector<std::size_t>& which, const CutRuns& runs) {
    bool fresh = false;
    for (const std::size_t run : which) {
      bool found = false;
      for (std::size_t i = run + 1; !found && i-- > 0;) {
        found = bar_run(runs.lines(i));
      }
      found = found || (run + 1 < runs.size() && bar_run(runs.lines(run + 1)));
      fresh = fresh || found;
    }
    return fresh;
  }
  /// Bars lines that are not worth it.
  void bar(const std::vector<std::uint32_t>& lines) { lines_.insert(lines.begin(), lines.end()); }

  [[nodiscard]] const std::set<std::uint32_t>& lines() const noexcept { return lines_; }
  /// Of the pieces that bar_beyond() has seen last.
  [[nodiscard]] double largest_shift_mm() const noexcept { return largest_shift_mm_; }

  std::vector<std::uint32_t> too_far;
  std::vector<std::uint32_t> past_travel;
  std::vector<std::uint32_t> worse;

 private:
  bool bar_run(const std::vector<std::uint32_t>& lines) {
    if (std::ranges::all_of(lines, [&](std::uint32_t line) { return lines_.contains(line); })) {
      return false;
    }
    add(lines, worse);
    return true;
  }
  void add(const std::vector<std::uint32_t>& lines, std::vector<std::uint32_t>& why) {
    why.insert(why.end(), lines.begin(), lines.end());
    bar(lines);
  }

  const nc::plan::PlannedPath& path_;
  Travel travel_;
  double max_shift_mm_;
  double largest_shift_mm_ = 0.0;
  std::set<std::uint32_t> lines_;
};

}  // namespace steadyrest::contour::offline
