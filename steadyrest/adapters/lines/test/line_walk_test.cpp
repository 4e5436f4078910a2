// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/line_walk.hpp>
#include <steadyrest/adapters/lines/testing/held_wires.hpp>
#include <steadyrest/kernel/override/gray.hpp>

namespace steadyrest::adapters::lines {
namespace {

using ::testing::ElementsAre;
using testing::Held;
using testing::HeldWires;
using ::testing::IsEmpty;

kernel::machine::OverrideTable gray_of(std::size_t steps) {
  kernel::machine::OverrideTable table;
  for (std::size_t i = 0; i < steps; ++i) {
    table.ratio.push_back(0.1 * static_cast<double>(i));
    table.code.push_back(kernel::override::sinumerik_code(i));
  }
  return table;
}

TEST(LineWalk, GoesThroughTheTableByNeighboursWithMasksOffAndBackToTheFirst) {
  Held held;
  held.outputs = Levels(0xFFFF);
  HeldWires wires(held);
  kernel::machine::Lines lines;
  lines.feed.panel = {0, 1, 2, 3};
  lines.feed.out = {4, 5, 6, 7};
  lines.feed.mask = 8;
  lines.spindle.mask = 9;
  const auto table = gray_of(9);
  const auto seen = walk(wires, lines, lines.feed, table, [&held] {
    held.inputs = held.outputs >> 4;  // jumpers
  });
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->copy.size(), 10U);
  EXPECT_THAT(diagnose(seen->copy, 4), IsEmpty());
  EXPECT_THAT(diagnose(seen->inputs, 4), IsEmpty());
  for (const Levels& written : held.written) {
    EXPECT_FALSE(written[8] || written[9]);
    EXPECT_TRUE(written[12]) << "what is not the layer's stays";
  }
  EXPECT_EQ(word_of(held.outputs, lines.feed.out, false), table.code.front());
}

TEST(PanelWatch, TakesAWordThatTwoReadingsShow) {
  PanelWatch watch(3);
  for (const std::uint32_t word : {1U, 1U, 1U, 5U, 3U, 3U, 3U, 2U, 2U}) {
    watch.see(word);
  }
  EXPECT_THAT(watch.words(), ElementsAre(1U, 3U, 2U)) << "5 was bounce";
  EXPECT_TRUE(watch.complete());
}

// Turned from the first position to the last, with two wires swapped.
TEST(PanelWatch, TheTurnedSwitchTellsItsWiring) {
  const auto table = gray_of(23);
  PanelWatch watch(23);
  for (const std::uint32_t code : table.code) {
    const std::uint32_t seen = (code & ~3U) | (code >> 1U & 1U) | (code << 1U & 2U);
    watch.see(seen);
    watch.see(seen);
  }
  ASSERT_TRUE(watch.complete());
  EXPECT_THAT(diagnose(paired(table, watch.words()), 5),
              ElementsAre(WireFault{0, WireFault::Kind::swapped, 1},
                          WireFault{1, WireFault::Kind::swapped, 0}));
}

PanelWatch after(std::size_t steps, const std::vector<std::uint32_t>& words) {
  PanelWatch watch(steps);
  for (const std::uint32_t word : words) {
    watch.see(word);
    watch.see(word);
  }
  return watch;
}

TEST(PanelWatch, TheSwitchMayBeTurnedToAndFro) {
  const PanelWatch watch = after(5, {1, 3, 2, 3, 1, 3, 2, 6, 2, 6, 7});
  EXPECT_THAT(watch.words(), ElementsAre(1, 3, 2, 6, 7));
  EXPECT_TRUE(watch.complete());
  EXPECT_EQ(watch.out_of_order(), 0);
}

TEST(PanelWatch, TheSwitchMayStandInTheMiddleAtTheBeginning) {
  const PanelWatch watch = after(5, {2, 3, 1, 3, 2, 6, 7});
  EXPECT_THAT(watch.words(), ElementsAre(1, 3, 2, 6, 7)) << "it ends at the last position";
  EXPECT_TRUE(watch.complete());
  EXPECT_FALSE(after(5, {2, 6, 7, 6, 2, 3, 1, 3}).complete()) << "not at an end of the switch";
}

TEST(PanelWatch, AWordFromElsewhereIsOutOfOrder) {
  const PanelWatch watch = after(5, {1, 3, 2, 1, 3, 2, 6, 7});
  EXPECT_EQ(watch.out_of_order(), 1) << "2, then 1";
  EXPECT_THAT(watch.words(), ElementsAre(1, 3, 2, 6, 7));
}

TEST(PanelWatch, ALooseContactIsOutOfOrder) {
  const PanelWatch watch = after(5, {1, 3, 2, 0, 2, 6, 7});
  EXPECT_EQ(watch.out_of_order(), 1);
  EXPECT_THAT(watch.words(), ElementsAre(1, 3, 2, 6, 7));
}

TEST(PanelWatch, BitsThatNeverChangeAreStuckWhateverTheOrder) {
  const auto table = gray_of(8);
  EXPECT_THAT(stuck(table, {1, 3, 7, 15, 13}, 4),
              ElementsAre(WireFault{0, WireFault::Kind::stuck_on, 0}));
  EXPECT_THAT(stuck(table, {0, 1, 5}, 4), ElementsAre(WireFault{1, WireFault::Kind::stuck_off, 1},
                                                      WireFault{3, WireFault::Kind::stuck_off, 3}));
  EXPECT_THAT(stuck(table, {1}, 4), IsEmpty()) << "nobody has turned the switch";
}

}  // namespace
}  // namespace steadyrest::adapters::lines
