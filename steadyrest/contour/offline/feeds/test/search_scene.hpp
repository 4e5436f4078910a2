// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/feed_search.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>

namespace steadyrest::contour::offline::test {

/// Moves on an ideal mill of 50 1/s, divided into cells, and the search of their feeds.
class SearchScene {
 public:
  explicit SearchScene(const std::string& moves, const FeedSearch::Config& config = {},
                       const FeedRoom& room = {})
      : machine(ideal_mill()),
        path(planned_moves(machine, moves)),
        cells(feed_cells(path, same_path(path), room)),
        search(machine, cells, path, servo_models(machine.axes), config) {}
  SearchScene(const SearchScene&) = delete;
  SearchScene& operator=(const SearchScene&) = delete;
  ~SearchScene() = default;

  double measured_s() {
    const auto seconds = search.measure();
    EXPECT_TRUE(seconds.has_value());
    return seconds.value_or(0.0);
  }
  /// The cell in the middle of a segment.
  [[nodiscard]] std::size_t middle(std::uint32_t segment) const {
    const auto [first, end] = std::ranges::equal_range(cells.of, segment);
    return static_cast<std::size_t>(first - cells.of.begin() + (end - first) / 2);
  }
  [[nodiscard]] double middle_ratio(std::uint32_t segment) const {
    return search.ratio()[middle(segment)];
  }

  kernel::machine::Machine machine;
  nc::plan::PlannedPath path;
  FeedCells cells;
  FeedSearch search;
};

}  // namespace steadyrest::contour::offline::test
