// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/feeds/feed_search.hpp>

namespace steadyrest::contour::offline {

/// How few feeds are worth the time that they cost.
struct FewFeeds {
  double most_loss_s = 1.0;   ///< of the whole program
  double shortest_s = 0.012;  ///< a part of a segment takes at least so long
};

/// Cells with one feed each → groups of neighbours with one feed, the lowest of theirs.
///
/// Two neighbours whose union costs the least time are united, again and again, until the next
/// would exceed the loss; parts too short for a block are united first, at any cost. A cell that
/// does not reach its feed loses nothing above its speed. The result is the group of each cell,
/// ascending; `ratio` becomes that of its group.
[[nodiscard]] std::vector<std::uint32_t> group_feeds(const FeedCells& cells,
                                                     const FeedSearch& search, const FewFeeds& few,
                                                     std::vector<double>& ratio);

}  // namespace steadyrest::contour::offline
