// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/follow/route.hpp>

namespace steadyrest::nc::follow {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Route of_lines(const std::vector<std::uint32_t>& lines) {
  std::vector<kernel::signal::PathSegment> path(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    path[i].line = lines[i];
  }
  return Route(path);
}

TEST(Route, GivesALinesSegmentsInTheOrderOfThePath) {
  const Route route = of_lines({3, 4, 5, 3, 4, 5, 9});
  EXPECT_THAT(route.of_line(4), ElementsAre(1U, 4U));
  EXPECT_THAT(route.of_line(9), ElementsAre(6U));
}

TEST(Route, GivesTheLineBeforeForOneThatWasMerged) {
  const Route route = of_lines({3, 7, 3, 7});
  EXPECT_THAT(route.of_line(5), ElementsAre(0U, 2U));
  EXPECT_THAT(route.of_line(100), ElementsAre(1U, 3U));
  EXPECT_THAT(route.of_line(2), IsEmpty());
  EXPECT_THAT(of_lines({}).of_line(2), IsEmpty());
}

}  // namespace
}  // namespace steadyrest::nc::follow
