// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <gmock/gmock.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/trial/replay/replay.hpp>
#include <steadyrest/trial/replay/testing/recorded_cut.hpp>

namespace steadyrest::trial::replay {
namespace {

using kernel::machine::Machine;

class Replay : public ::testing::Test {
 protected:
  Replay() { std::filesystem::remove(file_); }
  ~Replay() override { std::filesystem::remove(file_); }

  const std::string file_ = ::testing::TempDir() + "replay-" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                            ".sqlite";
};

constexpr std::uint64_t kAll = 1'000'000;

TEST_F(Replay, TheSameMachineDecidesTheSameBitForBit) {
  for (const char* const name : {"ideal-k50.toml", "vmc-840d.toml"}) {
    std::filesystem::remove(file_);
    const Machine machine = trial::test::machine_of(name);
    const auto cut = testing::record_cut(file_, machine, kAll);
    EXPECT_GT(cut.reduced, 1000U);
    EXPECT_EQ(cut.dropped, 0U);
    const auto replayed = replay(file_, machine).value();
    EXPECT_EQ(replayed.cycles, cut.cycles);
    EXPECT_EQ(replayed.different, 0U);
    EXPECT_FALSE(replayed.first_difference);
    EXPECT_FALSE(replayed.gap_after);
    EXPECT_TRUE(replayed.paths_complete);
  }
}

TEST_F(Replay, AnotherLimitNamesTheFirstCycleThatIsDecidedOtherwise) {
  Machine machine = trial::test::machine_of("vmc-840d.toml");
  const auto cut = testing::record_cut(file_, machine, kAll);
  machine.contour.limit_mm *= 2.0;
  const auto replayed = replay(file_, machine).value();
  EXPECT_EQ(replayed.cycles, cut.cycles);
  ASSERT_TRUE(replayed.first_difference);
  EXPECT_GT(replayed.first_difference->cycle, 1U);
  EXPECT_LT(replayed.first_difference->cycle, cut.cycles);
  EXPECT_THAT(replayed.first_difference->fields,
              ::testing::Contains(::testing::StartsWith("command.feed")));
  EXPECT_GT(replayed.different, 0U);
}

TEST_F(Replay, FollowsAMachineFileThatTookOver) {
  const Machine machine = trial::test::machine_of("vmc-840d.toml");
  std::string text =
      kernel::file::testing::text_of_file(trial::test::kExamples + "machines/vmc-840d.toml");
  const std::string limit = "limit_um = 10\n";
  text.replace(text.find(limit), limit.size(), "limit_um = 3\n");
  const auto cut = testing::record_cut(file_, machine, kAll, 0, {}, {.at = 400, .text = text});
  const auto replayed = replay(file_, machine).value();
  EXPECT_EQ(replayed.reloads, 1U);
  EXPECT_EQ(replayed.cycles, cut.cycles);
  EXPECT_FALSE(replayed.first_difference);
  const auto ignored = replay(file_, machine, [](double) { return true; }, Reloads::ignore).value();
  EXPECT_EQ(ignored.reloads, 1U);
  ASSERT_TRUE(ignored.first_difference);
  EXPECT_GE(ignored.first_difference->cycle, 400U);
}

TEST_F(Replay, RefusesAMachineFileThatCannotHaveTakenOver) {
  const Machine machine = trial::test::machine_of("vmc-840d.toml");
  const std::string text =
      kernel::file::testing::text_of_file(trial::test::kExamples + "machines/ideal-k50.toml");
  testing::record_cut(file_, machine, 300, 0, {}, {.at = 200, .text = text});
  const auto replayed = replay(file_, machine);
  ASSERT_FALSE(replayed);
  EXPECT_THAT(replayed.error().what, ::testing::HasSubstr("cannot change during a run"));
}

TEST_F(Replay, EndsBeforeALostSample) {
  const Machine machine = trial::test::machine_of("ideal-k50.toml");
  testing::record_cut(file_, machine, 300, 200);
  const auto replayed = replay(file_, machine).value();
  EXPECT_EQ(replayed.cycles, 199U);
  EXPECT_EQ(replayed.different, 0U);
  EXPECT_TRUE(replayed.gap_after);
}

TEST_F(Replay, RefusesWhatIsNoRecord) {
  EXPECT_FALSE(replay(file_, trial::test::machine_of("ideal-k50.toml")));
}

}  // namespace
}  // namespace steadyrest::trial::replay
