// SPDX-License-Identifier: Apache-2.0
#include <comedilib.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/testing/fake_cards.hpp>
#include <steadyrest/adapters/lines/wires.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::machine::LinesKind;
using testing::fake_cards;

Lines lines_of(LinesKind kind) {
  Lines lines;
  lines.kind = kind;
  lines.device = "here";
  lines.feed.panel = {2, 3, 4};
  lines.feed.out = {12, 11, 10};
  lines.feed.mask = 9;
  lines.running = 7;
  return lines;
}

class Cards : public ::testing::TestWithParam<LinesKind> {
 protected:
  Cards() {
    fake_cards() = {};
    fake_cards().chip = fake_cards().card = "here";
  }
  static bool gpio() { return GetParam() == LinesKind::gpio; }
  static void set_input(unsigned line) {
    fake_cards().level[line] = 1;
    fake_cards().bits[0] |= 1U << line;
  }
  static bool output(unsigned line) {
    return gpio() ? fake_cards().level[line] != 0 : (fake_cards().bits[1] >> line & 1U) != 0;
  }
};

TEST_P(Cards, CarryTheWordOnTheLinesOfTheMachineFile) {
  const auto wires = open_wires(lines_of(GetParam())).value();
  set_input(3);
  set_input(7);
  Levels inputs;
  Levels outputs;
  ASSERT_TRUE(wires->read(inputs, outputs));
  EXPECT_TRUE(inputs[3] && inputs[7]);
  EXPECT_FALSE(inputs[2] || inputs[4]);
  EXPECT_TRUE(outputs.none()) << "outputs begin at 0";
  Levels wanted;
  const auto lines = lines_of(GetParam());
  put_word(0b011, lines.feed.out, false, wanted);
  wanted.set(9);
  ASSERT_TRUE(wires->write(wanted));
  EXPECT_TRUE(output(12) && output(11) && output(9));
  EXPECT_FALSE(output(10));
  ASSERT_TRUE(wires->read(inputs, outputs));
  EXPECT_EQ(word_of(outputs, lines.feed.out, false), 0b011U);
}

TEST_P(Cards, WhatTheyLackIsRefusedByName) {
  Lines lines = lines_of(GetParam());
  lines.device = "elsewhere";
  EXPECT_FALSE(open_wires(lines));
  lines = lines_of(GetParam());
  lines.feed.out = {12, 11, 40};
  const auto beyond = open_wires(lines);
  ASSERT_FALSE(beyond);
  EXPECT_NE(kernel::outcome::text(beyond.error()).find("40"), std::string::npos);
}

TEST_P(Cards, AFailureInTheRunIsUnavailable) {
  const auto wires = open_wires(lines_of(GetParam())).value();
  fake_cards().fails = true;
  Levels inputs;
  Levels outputs;
  const auto read = wires->read(inputs, outputs);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_FALSE(wires->write(outputs));
}

TEST(GpioCards, ALineThatAnotherProgramHasIsRefused) {
  fake_cards() = {};
  fake_cards().chip = "here";
  fake_cards().direction[11] = -1;
  const auto taken = open_wires(lines_of(LinesKind::gpio));
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().what,
            "outputs 9, 10, 11, 12 cannot be taken from here: Device or resource busy");
  EXPECT_EQ(fake_cards().released, 4U) << "the inputs are given back";
}

TEST(GpioCards, OutputsAreLeftAsTheyAreUntilSomethingIsWritten) {
  fake_cards() = {};
  fake_cards().chip = "here";
  fake_cards().level[11] = 1;
  const auto wires = open_wires(lines_of(LinesKind::gpio)).value();
  Levels inputs;
  Levels outputs;
  ASSERT_TRUE(wires->read(inputs, outputs));
  EXPECT_TRUE(outputs[11]);
  EXPECT_EQ(fake_cards().direction[11], 3);
  ASSERT_TRUE(wires->write(Levels()));
  EXPECT_EQ(fake_cards().direction[11], 2);
  EXPECT_EQ(fake_cards().level[11], 0);
}

TEST(ComediCards, LinesAreTurnedToTheirDirection) {
  fake_cards() = {};
  fake_cards().card = "here";
  const auto wires = open_wires(lines_of(LinesKind::comedi)).value();
  EXPECT_EQ((fake_cards().turned[{0, 2}]), static_cast<unsigned>(COMEDI_INPUT));
  Levels inputs;
  Levels outputs;
  ASSERT_TRUE(wires->read(inputs, outputs));
  EXPECT_FALSE((fake_cards().turned.contains({1, 12}))) << "another layer may have a word there";
  ASSERT_TRUE(wires->write(Levels()));
  EXPECT_EQ((fake_cards().turned[{1, 12}]), static_cast<unsigned>(COMEDI_OUTPUT));
}

TEST(ComediCards, InputsAndOutputsThatAreNothingElseAreNotTurned) {
  fake_cards() = {};
  fake_cards().card = "here";
  fake_cards().fixed_direction = true;
  const auto wires = open_wires(lines_of(LinesKind::comedi)).value();
  ASSERT_TRUE(wires->write(Levels()));
  EXPECT_TRUE(fake_cards().turned.empty());
  auto exchanged = lines_of(LinesKind::comedi);
  exchanged.input_device = 1;
  exchanged.output_device = 0;
  const auto refused = open_wires(exchanged);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "subdevice 1 has no digital inputs");
}

INSTANTIATE_TEST_SUITE_P(Kinds, Cards, ::testing::Values(LinesKind::gpio, LinesKind::comedi),
                         [](const auto& kind) {
                           return kind.param == LinesKind::gpio ? "gpio" : "comedi";
                         });

}  // namespace
}  // namespace steadyrest::adapters::lines
