// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/testing/warm_axis.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/database.hpp>
#include <steadyrest/trial/listener/listener.hpp>
#include <steadyrest/trial/replay/replay.hpp>
#include <steadyrest/trial/replay/testing/recorded_cut.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

namespace steadyrest::trial::replay {
namespace {

using kernel::machine::Machine;

class Replay : public ::testing::Test {
 protected:
  const kernel::file::testing::OwnFolder folder_;
  const std::string file_ = folder_.at("run.sqlite");
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

/// The chatter room modulates in every cut; Z has a thermal model.
Machine with_rooms() {
  Machine machine = trial::test::machine_of("vmc-840d.toml");
  machine.chatter.enabled = true;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  machine.thermal.enabled = true;
  machine.thermal.slope_mm_s = 1.0;
  machine.thermal.max_offset_mm = 0.05;
  machine.envelope.max_offset_mm = 0.05;
  machine.thermal.axis = {kernel::testing::warm_z()};
  return machine;
}

supervisor::Wish modulation(double mean_ratio) {
  return {.what = chatter::online::Modulation{.law = chatter::online::Law::sine,
                                              .amplitude_ratio = 0.1 / 3.0,
                                              .period_s = 1.0 / 3.0,
                                              .mean_ratio = mean_ratio},
          .author = supervisor::ShortText<64>("page: otto (operator)")};
}

supervisor::Wish reading(double displacement_mm) {
  return {.what = supervisor::Measured{.axis = 2,
                                       .name = supervisor::ShortText<16>("Z"),
                                       .displacement_mm = displacement_mm,
                                       .sd_mm = 0.0003},
          .author = {}};
}

void change_record(const std::string& file, const char* sql) {
  auto database = record::Database::open_to_change(file);
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->run(sql));
}

// The same record without the event is decided otherwise from that cycle on.
TEST_F(Replay, GrantsWhatSomebodyAskedForInTheSameCycle) {
  const Machine machine = with_rooms();
  const std::vector<std::pair<supervisor::Wish, const char*>> asked = {
      {modulation(2.0 / 3.0), "command.spindle"}, {reading(0.0007), "command.offset"}};
  for (const auto& [wish, field] : asked) {
    std::filesystem::remove(file_);
    const auto cut =
        testing::record_cut(file_, machine, kAll, 0, {}, {}, {{.at = 400, .wish = wish}});
    ASSERT_EQ(cut.outcomes, std::vector{supervisor::WishOutcome::taken});
    EXPECT_EQ(cut.dropped, 0U);
    const auto replayed = replay(file_, machine).value();
    EXPECT_EQ(replayed.wishes, 1U);
    EXPECT_EQ(replayed.cycles, cut.cycles);
    EXPECT_FALSE(replayed.first_difference);
    change_record(file_, "DELETE FROM event WHERE kind = 5");
    const auto without = replay(file_, machine).value();
    ASSERT_TRUE(without.first_difference);
    EXPECT_GE(without.first_difference->cycle, 400U);
    EXPECT_THAT(without.first_difference->fields,
                ::testing::Contains(::testing::StartsWith(field)));
  }
}

// An outlier moves nothing at once, but it counts in the window that judges the model.
TEST_F(Replay, GrantsWhatWasRejectedToo) {
  const Machine machine = with_rooms();
  std::vector<testing::WishAt> wishes;
  wishes.reserve(6);
  for (std::uint64_t i = 0; i < 6; ++i) {
    wishes.push_back({.at = 300 + 10 * i, .wish = reading(1.0)});
  }
  const auto cut = testing::record_cut(file_, machine, kAll, 0, {}, {}, wishes);
  EXPECT_THAT(cut.outcomes, ::testing::Each(supervisor::WishOutcome::rejected));
  EXPECT_FALSE(replay(file_, machine).value().first_difference);
  change_record(file_, "DELETE FROM event WHERE kind = 5");
  EXPECT_TRUE(replay(file_, machine).value().first_difference) << "the model is found unfit";
}

// Other limits: the chatter room starts over with the operator's modulation.
TEST_F(Replay, AnOperatorsModulationOutlivesAReload) {
  const std::string plain =
      kernel::file::testing::text_of_file(trial::test::kExamples + "machines/vmc-840d.toml") +
      "\n[chatter]\nenabled = true\nm_code_on = 0\nm_code_off = 0\n";
  std::string text = plain;
  const std::string most = "max_spindle_percent = 120\n";
  text.replace(text.find(most), most.size(), "max_spindle_percent = 110\n");
  const Machine began = passport::parse(plain, "plain").value();
  const auto cut = testing::record_cut(file_, began, kAll, 0, {}, {.at = 500, .text = text},
                                       {{.at = 400, .wish = modulation(0.9)}});
  EXPECT_EQ(cut.outcomes.size(), 1U);
  const auto replayed = replay(file_, began).value();
  EXPECT_EQ(replayed.reloads, 1U);
  EXPECT_EQ(replayed.wishes, 1U);
  EXPECT_EQ(replayed.cycles, cut.cycles);
  EXPECT_FALSE(replayed.first_difference);
}

TEST_F(Replay, RefusesAWishThatIsNone) {
  const Machine machine = with_rooms();
  testing::record_cut(file_, machine, 300, 0, {}, {}, {{.at = 200, .wish = reading(0.0)}});
  change_record(file_, "UPDATE event SET text = 'measure 2 Z much' WHERE kind = 5");
  const auto replayed = replay(file_, machine);
  ASSERT_FALSE(replayed);
  EXPECT_THAT(replayed.error().what,
              ::testing::HasSubstr("a wish that cannot be read: measure 2 Z much"));
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

/// The slot that chatters, with an ear for it.
testing::Heard slot(const Machine& machine) {
  constexpr double kDepth_mm = 0.6;
  constexpr double kSpeed_rev_s = 5000.0 / 60.0;
  const auto process =
      chatter::offline::read_process(trial::test::kExamples + "processes/slot-922hz.toml").value();
  return {.program = "slot.mpf",
          .cutting = sim::CuttingVibration::Config{.cut = vibration::cutting_of(process, kDepth_mm),
                                                   .slowest_rev_s = 0.5 * kSpeed_rev_s},
          .listener = listener::Listener{.stage = listener::stage_for(process, machine,
                                                                      {kSpeed_rev_s}, kDepth_mm,
                                                                      listener::simulated_sensor())
                                                      .value()}};
}

TEST_F(Replay, ALayerThatListenedHearsTheSameAgain) {
  const Machine machine = trial::test::machine_of("vmc-840d.toml");
  std::string text =
      kernel::file::testing::text_of_file(trial::test::kExamples + "machines/vmc-840d.toml");
  const std::string limit = "limit_um = 10\n";
  text.replace(text.find(limit), limit.size(), "limit_um = 9\n");
  // The file takes over while the spindle runs at the better step.
  const auto cut = testing::record_cut(file_, machine, kAll, 0, {}, {.at = 700, .text = text}, {},
                                       slot(machine));
  ASSERT_GT(cut.slowed, 300U) << "it heard nothing";
  ASSERT_EQ(cut.dropped, 0U);
  const auto replayed = replay(file_, machine).value();
  EXPECT_EQ(replayed.cycles, cut.cycles);
  EXPECT_EQ(replayed.reloads, 1U);
  EXPECT_FALSE(replayed.first_difference);
}

TEST_F(Replay, RefusesAListenerThatItCannotMake) {
  const Machine machine = trial::test::machine_of("vmc-840d.toml");
  testing::record_cut(file_, machine, 10);
  auto database = record::Database::open_to_change(file_).value();
  ASSERT_TRUE(database.run("UPDATE run SET listener = '{}'"));
  const auto replayed = replay(file_, machine);
  ASSERT_FALSE(replayed);
  EXPECT_THAT(replayed.error().what, ::testing::HasSubstr("how the layer listened"));
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
