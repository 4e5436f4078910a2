// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/listener/listener.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::listener {
namespace {

using kernel::machine::Machine;

constexpr double kSpeed_rev_s = 5000.0 / 60.0;

Machine mill() {
  return trial::test::machine_of("vmc-840d.toml");
}

chatter::offline::Process slot() {
  return chatter::offline::read_process(trial::test::kExamples + "processes/slot-922hz.toml")
      .value();
}

Listener some() {
  return {.process_file = "slot.toml",
          .process_text = "name = \"Nut, 922 Hz\"\n\\",
          .modes = slot().modes,
          .stage = stage_for(slot(), mill(), {kSpeed_rev_s}, 0.6, simulated_sensor()).value()};
}

TEST(Listener, IsTheSameAfterItsTextBitForBit) {
  Listener one = some();
  one.stage.better.table.limit_depth_mm[0] = 0.1 + 0.2;  // no short decimal
  one.stage.acts = false;
  const std::string text = text_of(one);
  const Listener again = parse(text, "a record").value();
  EXPECT_EQ(text_of(again), text);
  EXPECT_EQ(again.process_text, one.process_text);
  EXPECT_EQ(again.stage.acts, false);
  EXPECT_EQ(again.stage.depth_mm, 0.6);
  EXPECT_EQ(again.stage.better.table.speed_rev_s, one.stage.better.table.speed_rev_s);
  EXPECT_EQ(again.stage.better.table.limit_depth_mm, one.stage.better.table.limit_depth_mm);
  EXPECT_EQ(again.stage.better.detector.least_energy, one.stage.better.detector.least_energy);
  ASSERT_EQ(again.modes.size(), 1U);
  EXPECT_EQ(again.modes[0].frequency_hz, 922.0);
  EXPECT_EQ(again.modes[0].damping_ratio, 0.011);
}

TEST(Listener, RefusesATextThatIsNotItsOwn) {
  for (const char* const text : {"", "{}", "[1]", R"({"process":1})", "{"}) {
    const auto read = parse(text, "run.sqlite");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().file, "run.sqlite");
  }
  std::string cut = text_of(some());
  cut.replace(cut.find("\"sure_ratio\""), 12, "\"sure_ration\"");
  EXPECT_FALSE(parse(cut, "run.sqlite"));
}

TEST(Listener, OneThatActsHasTheModulatorToItself) {
  Machine file = mill();
  file.chatter.enabled = true;
  file.chatter.amplitude_ratio = 0.2;
  Listener listener = some();
  EXPECT_EQ(machine_for(&listener, file).chatter.amplitude_ratio, 0.0);
  listener.stage.acts = false;
  EXPECT_EQ(machine_for(&listener, file).chatter, file.chatter);
}

TEST(Listener, WithoutASpindleOverrideItMayOnlyHear) {
  Machine machine = mill();
  machine.spindle_override = {};
  Listener listener = some();
  const kernel::port::Capability port{.feed_override = true};
  const auto layer = layer_of(&listener, machine_for(&listener, machine), port);
  ASSERT_FALSE(layer);
  EXPECT_THAT(layer.error().what, ::testing::HasSubstr("spindle override"));
  listener.stage.acts = false;
  EXPECT_TRUE(layer_of(&listener, machine, port));
  EXPECT_TRUE(layer_of(nullptr, machine, port));
}

// A programmed speed that nobody knows: the deepest step must be the one that the planner finds.
TEST(Listener, WithoutProgrammedSpeedsTheTableHasTheWholeBorder) {
  const auto known = stage_for(slot(), mill(), {kSpeed_rev_s}, 0.6, simulated_sensor()).value();
  const auto all = stage_for(slot(), mill(), {}, 0.6, simulated_sensor()).value();
  const auto at = [](const supervisor::ListeningStage::Config& stage, double speed_rev_s) {
    return chatter::online::SpeedTable::make(stage.better.table)
        .value()
        .limit_depth_mm(speed_rev_s);
  };
  for (const double ratio : {0.6, 0.8, 0.9, 1.0}) {
    const double expected = at(known, ratio * kSpeed_rev_s);
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(at(all, ratio * kSpeed_rev_s), expected, 0.02 * expected) << ratio;
  }
}

}  // namespace
}  // namespace steadyrest::trial::listener
