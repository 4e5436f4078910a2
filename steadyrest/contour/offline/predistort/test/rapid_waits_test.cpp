// SPDX-License-Identifier: Apache-2.0
// A cut waits where a rapid has left the tool beside its path. Truth: the law of a first-order
// servo, e·exp(−k·t), and the text planned and run afresh.
#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/causes/causes.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>

namespace steadyrest::contour::offline {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kWaitGain_1_s = 30.0;
constexpr double kHeld_mm = 0.01;

class RapidWaits : public testing::Test {
 protected:
  Predistorted held(const std::string& moves, double hold_mm = kHeld_mm) {
    text_ = "G21 G90 G94 G17 G61\n" + moves + "M2\n";
    std::ofstream(file(), std::ios::binary) << text_;
    const PredistortConfig how{
        .limit_mm = kHeld_mm,
        .hold_mm = hold_mm,
        .told = {{"changes", "predistort,feeds,dwells"}, {"tube-mm", "0.5"}}};
    return predistort(file(), config_, machine_, how).value();
  }
  [[nodiscard]] std::string file() const { return folder_.at("part.ngc"); }

  kernel::file::testing::OwnFolder folder_;
  kernel::machine::Machine machine_ = test::ideal_mill(kWaitGain_1_s);
  nc::interpret::Config config_;
  std::string text_;
};

/// Seconds of the text's first dwell; 0: it has none.
double first_wait_s(const std::string& text) {
  const auto at = text.find("G4 P");
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + 4));
}

TEST_F(RapidWaits, UntilTheRestOfTheRapidIsWithinTheLimit) {
  const std::string rapid = "G0 X0 Y0\nG0 X60\n";
  const auto done = held(rapid + "G1 Y60 F600\nG0 X0\n");
  EXPECT_GT(done.before.nominal().max_mm, 5.0 * kHeld_mm);
  EXPECT_LE(done.after.nominal().max_mm, kHeld_mm);
  ASSERT_EQ(done.waits.size(), 1U);
  const double wait_s = first_wait_s(done.replaced.text);
  EXPECT_DOUBLE_EQ(wait_s, done.waits.at(4));
  // The error when the program as it is begins to cut has fallen to the limit, and not by far more.
  const double least_s = std::log(done.before.nominal().max_mm / kHeld_mm) / kWaitGain_1_s;
  EXPECT_GE(wait_s, least_s);
  EXPECT_LE(wait_s, least_s + 2.5 / kWaitGain_1_s);
  EXPECT_LE(done.seconds_after, done.seconds_before + wait_s + 0.02);
  // The cut is good as it is: its line is the program's own.
  EXPECT_THAT(done.replaced.text, HasSubstr("\nG1 Y60 F600 ;STEADYREST new"));
  std::ofstream(file(), std::ios::binary) << done.replaced.text;
  EXPECT_EQ(nc::rewrite::put_back(file())->text, text_);
}

// While the control waits for the spindle a dwell changes nothing, whatever part of it that is.
TEST_F(RapidWaits, LongerThanTheControlWaitsForTheSpindle) {
  std::size_t waits = 0;
  for (const double acceleration_rev_s2 : {100.0, 150.0, 200.0, 250.0, 300.0, 400.0, 600.0}) {
    machine_.spindle.acceleration_rev_s2 = acceleration_rev_s2;
    const auto done = held("G0 X0 Y0 Z10\nS3000 M3\nG0 Z2\nG1 X60 F3000\nG0 X0\n");
    EXPECT_LE(done.after.nominal().max_mm, kHeld_mm) << acceleration_rev_s2;
    waits += done.waits.size();
  }
  EXPECT_GE(waits, 2U);
}

TEST_F(RapidWaits, BeforeWhatIsShapedAnew) {
  const auto done = held("G0 X0 Y0\nG0 X60\nG1 Y10 F1200\nG3 X50 Y20 I-10 J0\nG1 X0\nG0 Y0\n");
  EXPECT_EQ(done.waits.size(), 1U);
  EXPECT_LE(done.after.nominal().max_mm, kHeld_mm);
  EXPECT_GT(done.replaced.replaced, 1U);
}

TEST_F(RapidWaits, NotWhereTheRapidLeavesNothing) {
  // Along the cut's own line; and with nothing to be held.
  EXPECT_EQ(held("G0 X0 Y0\nG0 X60\nG1 X90 F600\nG0 X0\n").waits.size(), 0U);
  const auto open = held("G0 X0 Y0\nG0 X60\nG1 Y60 F600\nG0 X0\n", 0.0);
  EXPECT_EQ(open.waits.size(), 0U);
  EXPECT_THAT(open.replaced.text, Not(HasSubstr("G4")));
}

TEST_F(RapidWaits, NotBeforeABlockThatMustStay) {
  const auto done = held("G0 X0 Y0\nG0 X60\n/G1 Y60 F600\nG0 X0\nG1 X1 F600\n");
  EXPECT_EQ(done.waits.size(), 0U);
  EXPECT_THAT(done.replaced.text, Not(HasSubstr("G4")));
}

}  // namespace
}  // namespace steadyrest::contour::offline
