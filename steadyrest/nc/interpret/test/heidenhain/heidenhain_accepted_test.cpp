// SPDX-License-Identifier: Apache-2.0
// Whole Klartext programs beside their moves in G code, which rs274 judges as well.
#include <cmath>
#include <filesystem>

#include <steadyrest/nc/interpret/test/heidenhain/heidenhain.hpp>

namespace steadyrest::nc::interpret {
namespace {

namespace fs = std::filesystem;

std::vector<Move> moves_of_file(const fs::path& file, const Config& config) {
  Kept kept;
  const auto report = run_file(file.string(), config, kept);
  EXPECT_TRUE(report.has_value() && report->refused.empty()) << file;
  return kept.moves;
}

TEST(HeidenhainPrograms, MoveTheMachineAsTheirTwins) {
  constexpr double kEqual = 1e-9;
  int compared = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STEADYREST_SOURCE_DIR) / "tests/accepted/nc/heidenhain")) {
    fs::path twin = entry.path();
    if (twin.extension() != ".H") {
      continue;
    }
    const auto ours = moves_of_file(entry.path(), test::heidenhain());
    const auto theirs = moves_of_file(twin.replace_extension(".ngc"), {});
    ASSERT_EQ(ours.size(), theirs.size()) << twin;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const Axes end = machine_of(ours[i], ours[i].end);
      const Axes their_end = machine_of(theirs[i], theirs[i].end);
      EXPECT_EQ(ours[i].kind, theirs[i].kind) << twin << i;
      EXPECT_EQ(ours[i].turns, theirs[i].turns) << twin << i;
      EXPECT_EQ(ours[i].dwell_s, theirs[i].dwell_s) << twin << i;
      EXPECT_NEAR(ours[i].feed_mm_s, theirs[i].feed_mm_s, kEqual) << twin << i;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(end[axis], their_end[axis], kEqual) << twin << i;
        EXPECT_NEAR(ours[i].centre_mm[axis], theirs[i].centre_mm[axis], kEqual) << twin << i;
      }
      ++compared;
    }
  }
  EXPECT_GE(compared, 60);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
