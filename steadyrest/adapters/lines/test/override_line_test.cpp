// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/override_line.hpp>
#include <steadyrest/kernel/override/gray.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Wiring;
using kernel::override::sinumerik_code;

// SINUMERIK's 23 positions as delivered: 0 … 120 %.
kernel::machine::OverrideTable table_840d() {
  kernel::machine::OverrideTable table;
  table.ratio = {0,  .01, .02, .04, .06, .08, .1,  .2,   .3,  .4,   .5, .6,
                 .7, .75, .8,  .85, .9,  .95, 1.0, 1.05, 1.1, 1.15, 1.2};
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    table.code.push_back(sinumerik_code(i));
  }
  table.latched_word = false;
  return table;
}

constexpr std::size_t k50 = 10;
constexpr std::size_t k60 = 11;
constexpr std::size_t k100 = 18;
constexpr std::uint32_t kMask = 12;

struct Scene {
  explicit Scene(Wiring wiring, bool panel_inverted = false, bool out_inverted = false)
      : line(OverrideLine::make(
                 {.wires = {.panel = {0, 1, 2, 3, 4},
                            .out = {7, 8, 9, 10, 11},
                            .mask = wiring == Wiring::through ? kernel::machine::kNoLine : kMask,
                            .panel_inverted = panel_inverted,
                            .out_inverted = out_inverted},
                  .table = table_840d(),
                  .wiring = wiring})
                 .value()) {}

  OverrideLine::Seen panel(std::uint32_t code) {
    put_word(code, line.config().wires.panel, line.config().wires.panel_inverted, inputs);
    return line.see(inputs, outputs);
  }
  bool put(std::size_t step, bool masks, bool step_time = true) {
    return line.put({.code = sinumerik_code(step), .masks = masks}, step_time, outputs);
  }
  [[nodiscard]] std::uint32_t out() const {
    return word_of(outputs, line.config().wires.out, line.config().wires.out_inverted);
  }

  OverrideLine line;
  Levels inputs;
  Levels outputs;
};

TEST(OverrideLine, ReadsThePanelsCodeAndKeepsTheLastKnownRatio) {
  Scene scene(Wiring::plc);
  auto seen = scene.panel(0b11010);  // HT 2 switch table: position 19, 100 %
  EXPECT_TRUE(seen.panel_known);
  EXPECT_DOUBLE_EQ(seen.panel_ratio, 1.0);
  seen = scene.panel(0b01110);
  EXPECT_DOUBLE_EQ(seen.panel_ratio, 0.5);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(scene.panel(0).panel_known) << "it may be a bounce";
  }
  seen = scene.panel(0);  // an open cable
  EXPECT_FALSE(seen.panel_known);
  EXPECT_DOUBLE_EQ(seen.panel_ratio, 0.5);
  EXPECT_EQ(seen.panel_code, 0U);
}

TEST(OverrideLine, InvertedWiresCarryTheSameWord) {
  Scene scene(Wiring::plc, true, true);
  scene.inputs = Levels(0b00101);
  EXPECT_DOUBLE_EQ(scene.panel(0b11010).panel_ratio, 1.0);
  EXPECT_EQ(scene.inputs, Levels(0b00101));
  scene.put(k100, true);
  EXPECT_EQ(scene.outputs >> 7 & Levels(0b11111), Levels(0b00101));
}

TEST(OverrideLine, ThePlcGetsWordAndMaskAsTheLayerHasThem) {
  Scene scene(Wiring::plc);
  scene.panel(sinumerik_code(k100));
  EXPECT_FALSE(scene.put(k100, false));
  EXPECT_FALSE(scene.outputs[kMask]);
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  EXPECT_TRUE(scene.put(k100, true));
  EXPECT_TRUE(scene.outputs[kMask]);
  EXPECT_DOUBLE_EQ(scene.panel(sinumerik_code(k50)).effective_ratio, 0.5) << "the lower one";
  EXPECT_DOUBLE_EQ(scene.panel(sinumerik_code(k100)).effective_ratio, 1.0);
}

// Bits of a word and a mask that come together could be read apart.
TEST(OverrideLine, ThePlcsMaskComesOnceThePanelsWordHasBeenThereForAScan) {
  Scene scene(Wiring::plc);
  scene.panel(sinumerik_code(k100));
  EXPECT_FALSE(scene.put(k50, true));
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  EXPECT_FALSE(scene.put(k50, true, false));
  EXPECT_TRUE(scene.put(k50, true));
  EXPECT_EQ(scene.out(), sinumerik_code(k100 - 1)) << "a safe step with it";
  scene.panel(0);  // an open cable: the PLC keeps the operator's last word by itself
  EXPECT_TRUE(scene.put(k50, true));
  scene.line.adopt(scene.outputs);
  EXPECT_TRUE(scene.put(k50, true)) << "goes on from what the outputs are";
  scene.line.adopt(Levels());
  EXPECT_FALSE(scene.put(k50, true)) << "no mask begins at an unknown panel";
}

TEST(OverrideLine, TheRelayStaysInAndPassesThePanelOn) {
  Scene scene(Wiring::relay);
  scene.panel(sinumerik_code(k100));
  EXPECT_FALSE(scene.put(k50, true)) << "the panel's word settles first";
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  EXPECT_FALSE(scene.put(k50, true, false)) << "for a scan";
  EXPECT_TRUE(scene.put(k50, false)) << "no mask: the panel's own word through the relay";
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  scene.panel(sinumerik_code(k100 + 1));
  scene.put(k50, false);
  EXPECT_EQ(scene.out(), sinumerik_code(k100 + 1));
}

TEST(OverrideLine, TheRelayFallsForTheOperator) {
  Scene scene(Wiring::relay);
  scene.panel(sinumerik_code(k60));
  scene.put(k60, true);
  ASSERT_TRUE(scene.put(k60, true));
  for (const std::uint32_t code : {sinumerik_code(0), 0U, sinumerik_code(k50)}) {
    for (int i = 0; i < (code == 0U ? 3 : 1); ++i) {
      scene.panel(code);
    }
    EXPECT_FALSE(scene.put(k60, true)) << code;
    EXPECT_FALSE(scene.outputs[kMask]);
    scene.panel(sinumerik_code(k60));
    scene.put(k60, true);
    EXPECT_TRUE(scene.put(k60, true));
  }
}

TEST(OverrideLine, AContactThatBouncesMovesNoRelay) {
  Scene scene(Wiring::relay);
  scene.panel(sinumerik_code(k100));
  scene.put(k60, true);
  ASSERT_TRUE(scene.put(k60, true));
  for (const std::uint32_t code : {0U, 0b10101U}) {
    scene.panel(code);
    EXPECT_TRUE(scene.put(k60, true));
    EXPECT_EQ(scene.out(), sinumerik_code(k60));
  }
  scene.panel(0);
  EXPECT_FALSE(scene.put(k60, true));
}

TEST(OverrideLine, InAThreadNoRelayComesInAndOneThatIsInStays) {
  Scene scene(Wiring::relay);
  scene.panel(sinumerik_code(k100));
  scene.line.hold(true);
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(scene.put(k100, true));
  }
  scene.line.hold(false);
  EXPECT_TRUE(scene.put(k100, true));
  scene.line.hold(true);
  EXPECT_TRUE(scene.put(k100, true));
}

// The module has kept word and mask for longer than the machine does: the relay may have fallen.
TEST(OverrideLine, AnOldMaskDoesNotCount) {
  Scene scene(Wiring::relay);
  scene.panel(sinumerik_code(k100));
  for (int i = 0; i < 3; ++i) {
    scene.put(k60, true);
  }
  ASSERT_EQ(scene.out(), sinumerik_code(k60));
  scene.line.adopt(scene.outputs, true);
  EXPECT_FALSE(scene.put(k50, true));
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  EXPECT_TRUE(scene.put(k100, true)) << "once the panel's word has been there";
}

TEST(OverrideLine, ThroughAnOldWordRisesOneStepAtATime) {
  Scene scene(Wiring::through);
  scene.panel(sinumerik_code(k100));
  scene.put(k60, true);
  ASSERT_EQ(scene.out(), sinumerik_code(k60));
  scene.line.adopt(scene.outputs, true);
  for (std::size_t step = k60 + 1; step <= k100; ++step) {
    scene.put(k100, true, false);
    EXPECT_EQ(scene.out(), sinumerik_code(step - 1)) << "not before its scan";
    scene.put(k100, true);
    EXPECT_EQ(scene.out(), sinumerik_code(step));
  }
}

TEST(OverrideLine, ThroughPassesWhateverThePanelShows) {
  Scene scene(Wiring::through);
  scene.panel(0b10101);  // not in this table
  scene.put(k50, false);
  EXPECT_EQ(scene.out(), 0b10101U);
  scene.panel(sinumerik_code(k100));
  scene.put(k100, true);
  EXPECT_EQ(scene.out(), sinumerik_code(k100));
  scene.panel(sinumerik_code(0));
  scene.put(k100, true);
  EXPECT_EQ(scene.out(), sinumerik_code(0)) << "the operator's 0";
}

// A mask output that nothing switches says nothing about which word is in force.
TEST(OverrideLine, ThroughShowsTheWordOnTheWiresWithAMaskToo) {
  auto line = OverrideLine::make(
                  {.wires = {.panel = {0, 1, 2, 3, 4}, .out = {7, 8, 9, 10, 11}, .mask = kMask},
                   .table = table_840d(),
                   .wiring = Wiring::through})
                  .value();
  Levels inputs;
  Levels outputs;
  put_word(sinumerik_code(k100), line.config().wires.panel, false, inputs);
  put_word(sinumerik_code(k50), line.config().wires.out, false, outputs);
  EXPECT_DOUBLE_EQ(line.see(inputs, outputs).effective_ratio, 0.5);
}

// What a lost order leaves out, the wires walk all the same.
TEST(OverrideLine, AJumpOnSeparateWiresBecomesAWalk) {
  Scene scene(Wiring::plc);
  scene.panel(sinumerik_code(k100));
  scene.put(k100, true);
  scene.put(k50, true, false);
  EXPECT_EQ(scene.out(), sinumerik_code(k100)) << "it has not been there for a scan";
  for (std::size_t step = k100 - 1; step >= k50; --step) {
    scene.put(k50, true);
    EXPECT_EQ(scene.out(), sinumerik_code(step));
  }
}

TEST(OverrideLine, NeverWritesAWordThatIsNotInTheTable) {
  std::mt19937 dice(1);  // NOLINT(bugprone-random-generator-seed): the same cases each time
  for (const Wiring wiring : {Wiring::relay, Wiring::plc}) {
    Scene scene(wiring);
    std::uint32_t before = sinumerik_code(k100);
    scene.panel(before);
    scene.put(k100, true);
    for (int i = 0; i < 200000; ++i) {
      scene.panel(dice() % 4 == 0 ? static_cast<std::uint32_t>(dice()) % 32
                                  : sinumerik_code(dice() % 23));
      scene.line.put({.code = static_cast<std::uint32_t>(dice() % 3 == 0 ? dice() : dice() % 32),
                      .masks = dice() % 2 == 0},
                     dice() % 2 == 0, scene.outputs);
      const std::uint32_t out = scene.out();
      ASSERT_TRUE(scene.line.table().step_of_code(out).has_value()) << out;
      ASSERT_LE(std::popcount(out ^ before), 1) << "one wire at a time";
      before = out;
    }
  }
}

TEST(OverrideLine, BinaryOnSeparateWiresIsRefused) {
  auto table = table_840d();
  table.coding = kernel::machine::Coding::binary;
  for (std::size_t i = 0; i < table.code.size(); ++i) {
    table.code[i] = static_cast<std::uint32_t>(100.0 * table.ratio[i] + 0.5);
  }
  const auto made =
      OverrideLine::make({.wires = {.panel = {0}, .out = {0}, .mask = 1}, .table = table});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().to_do.find("Gray"), std::string::npos);
}

// Five positions at 50 %: the word goes from the first to the panel's last bit by bit, although the
// ratio is the same. At once it would pass words that mean something else.
TEST(OverrideLine, BetweenEqualStepsItWalksToo) {
  auto table = table_840d();
  for (std::size_t i = 7; i < 12; ++i) {
    table.ratio[i] = 0.2;
  }
  Scene scene(Wiring::through);
  scene.line = OverrideLine::make(
                   {.wires = scene.line.config().wires, .table = table, .wiring = Wiring::through})
                   .value();
  scene.panel(sinumerik_code(11));
  put_word(sinumerik_code(7), scene.line.config().wires.out, false, scene.outputs);
  scene.line.adopt(scene.outputs);
  std::uint32_t before = scene.out();
  for (int i = 0; i < 10; ++i) {
    scene.line.release(true, scene.outputs);
    EXPECT_LE(std::popcount(before ^ scene.out()), 1) << i;
    before = scene.out();
  }
  EXPECT_EQ(before, sinumerik_code(11));
}

}  // namespace
}  // namespace steadyrest::adapters::lines
