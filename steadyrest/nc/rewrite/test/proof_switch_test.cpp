// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/pockets.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

// A changed program must be right in both positions of block delete.
namespace steadyrest::nc::rewrite {
namespace {

using test::fault;
using test::kHead;
using test::kPasses;
using test::pockets;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Clearances between Z50 and a rapid to Z60; `/N90` leads to Z2 where it is not skipped.
const std::string kClamp =
    kHead +
    "N50 G0 X0 Y0 Z10\nN60 G1 Z-1 F200\nN70 G1 X50\nN80 G0 Z50\n/N90 G0 Z2\nN95 G4 P20\n"
    "N100 G0 X0 Y0\nN110 G0 X100 Y0\nN120 G0 X100 Y50\nN130 G4 P20\nN140 G1 X60 F100\n"
    "N160 G0 Z60\nN170 M2\n";
const std::string kOneStep =
    R"({"transitions": [{"n": 2, "t_min": [0.735, 0.70], "delta_um": [0, 50]}]})";

class Switch : public ::testing::Test {
 protected:
  Switch() { shop_.settings.window_s = 6.0; }
  Workshop shop_;
};

TEST_F(Switch, RestatesNoAxisThatStandsElsewhereWhenLinesAreSkipped) {
  EXPECT_THAT(fault(shop_, kClamp, kOneStep),
              AllOf(HasSubstr("no safe place"), HasSubstr("block delete on and off")));
  shop_.config.block_delete = true;
  EXPECT_THAT(fault(shop_, kClamp, kOneStep), HasSubstr("no safe place"));
  const std::string always = replaced(kClamp, "/N90", "N90");
  EXPECT_EQ(fault(shop_, always, kOneStep), "");
}

TEST_F(Switch, MovesOnToAPlaceThatIsOneInBothPositions) {
  const auto done =
      shop_.compensate(replaced(kClamp, "N110 G0 X100 Y0", "N110 G0 X100 Y0 Z50"), kOneStep);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(done->insertions.front().site, Site::rapid);
  EXPECT_THAT(text_of_file(shop_.changed()), HasSubstr("noted)\nN110 G0"));
}

TEST_F(Switch, ProvesForBothPositions) {
  const std::string always = replaced(kClamp, "/N90", "N90");
  ASSERT_TRUE(shop_.compensate(always, kOneStep));
  const std::string text = text_of_file(shop_.changed());
  test::write_file(shop_.original(), kClamp);
  EXPECT_THAT(shop_.fault(kOneStep, replaced(text, "\nN90", "\n/N90")), HasSubstr("no safe place"));
}

// Each changes the meaning of the lines after it.
TEST_F(Switch, PlacesNothingWhoseMeaningTheSwitchChanges) {
  EXPECT_EQ(fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", ""), kOneStep), "");
  for (const char* line : {"/G20", "/G91", "/G55", "/G10 L2 P1 Z3", "/G92 Z1", "/G41.1 D1 G1 X70",
                           "/G93", "/G81 X1 Z-1 R2", "/G7"}) {
    const std::string what =
        fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", std::string{line} + "\n"), kOneStep);
    EXPECT_THAT(what, HasSubstr("no safe place")) << line << "\n" << text_of_file(shop_.changed());
  }
}

TEST_F(Switch, ASkippedLineSaysNothing) {
  shop_.settings.window_s = 60.0;
  const std::string program = replaced(kClamp, "/N90 G0 Z2\n", "");
  EXPECT_EQ(fault(shop_, program, kOneStep), "");
  EXPECT_THAT(fault(shop_, replaced(program, " G54", "\n/G54"), kOneStep),
              HasSubstr("which work offset"));
  EXPECT_THAT(fault(shop_, replaced(program, " G90", "\n/G90"), kOneStep), HasSubstr("G90"));
}

TEST_F(Switch, TheEndIsWhereBothPositionsEnd) {
  shop_.config.block_delete = true;
  EXPECT_THAT(fault(shop_, replaced(kClamp, "/N90 G0 Z2\n", "/M2\n"), kOneStep),
              HasSubstr("no safe place"));
  shop_.config.block_delete = false;
  shop_.settings.window_s = 60.0;
  EXPECT_THAT(fault(shop_, replaced(kPasses, "M30\n", "/M30\nG0 Z30\nM30\n"), test::kGrowth),
              HasSubstr("ends"));
}

TEST_F(Switch, RefusesWhatCannotBeRunWithTheLinesSkipped) {
  EXPECT_THAT(fault(shop_, replaced(kClamp, "N170 M2", "/N170 M2"), kOneStep),
              HasSubstr("with block delete (lines with / skipped)"));
}

TEST_F(Switch, HoldsOnEveryControl) {
  for (const read::Dialect dialect : {read::Dialect::fanuc, read::Dialect::sinumerik}) {
    Workshop shop;
    shop.config.dialect = dialect;
    const bool fanuc = dialect == read::Dialect::fanuc;
    shop.settings.method = fanuc ? Method::fanuc : Method::frame_fine;
    shop.settings.window_s = 6.0;
    std::string program = replaced(kClamp, "N30 G43 H1\n", fanuc ? "N30 G43 H1\n" : "N30 D1\n");
    const std::string dwell = fanuc ? "G4 P20000" : "G4 F20";
    program = replaced(replaced(program, "G4 P20", dwell), "G4 P20\n", dwell + "\n");
    program = replaced(replaced(program, "G21 ", fanuc ? "G21 " : "G71 "), "N170 M2", "N170 M30");
    EXPECT_THAT(fault(shop, program, kOneStep), HasSubstr("no safe place"));
    EXPECT_EQ(fault(shop, replaced(program, "/N90", "N90"), kOneStep), "");
  }
}

TEST(OptionalStop, ChangesNothing) {
  EXPECT_EQ(fault(Workshop{}, pockets("M1\n")), "");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
