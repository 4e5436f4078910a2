// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

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
  /// Bars lines whose error would grow. True when one of them was not barred before.
  bool bar_worse(const std::vector<std::uint32_t>& lines) {
    const std::size_t before = lines_.size();
    add(lines, worse);
    return lines_.size() > before;
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
