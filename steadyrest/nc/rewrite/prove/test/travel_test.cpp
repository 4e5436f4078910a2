// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/prove/travel.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using interpret::MoveKind;
using test::kGrowth;
using test::kPasses;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using test::write_file;
using ::testing::HasSubstr;

Move arc(double end_x, double end_y, int turns) {
  Move move;
  move.kind = MoveKind::arc;
  move.start = {10.0, 0.0, 0.0};
  move.end = {end_x, end_y, -5.0};
  move.normal = {0.0, 0.0, 1.0};
  move.turns = turns;
  move.offset = {100.0, 200.0, 300.0};
  return move;
}

// Circle of radius 10 about the origin, from 0°; offsets 100, 200, 300.
TEST(Travel, CountsTheBulgeOfAnArcOnlyWhereItPasses) {
  // The quarter passes no axis direction between its ends, so they are its reach.
  const Move quarter = arc(0.0, 10.0, 1);
  EXPECT_NEAR(reach_of(quarter, 0).low_mm, 100.0, 1e-9);
  EXPECT_NEAR(reach_of(quarter, 0).high_mm, 110.0, 1e-9);
  const Move other_way = arc(0.0, 10.0, -1);  // 270°
  EXPECT_NEAR(reach_of(other_way, 0).low_mm, 90.0, 1e-9);
  EXPECT_NEAR(reach_of(other_way, 1).low_mm, 190.0, 1e-9);
  EXPECT_NEAR(reach_of(other_way, 1).high_mm, 210.0, 1e-9);
  // Ends short of 90°: no bulge in Y; with one turn more it passes all directions.
  const Move to_45 = arc(std::sqrt(50.0), std::sqrt(50.0), 1);
  EXPECT_NEAR(reach_of(to_45, 1).high_mm, 200.0 + std::sqrt(50.0), 1e-9);
  EXPECT_NEAR(reach_of(arc(std::sqrt(50.0), std::sqrt(50.0), 2), 1).high_mm, 210.0, 1e-9);
  EXPECT_NEAR(reach_of(arc(10.0, 0.0, 1), 0).low_mm, 90.0, 1e-9);  // a full circle
  EXPECT_NEAR(reach_of(quarter, 2).low_mm, 295.0, 1e-9);           // along the helix
  EXPECT_NEAR(reach_of(quarter, 2).high_mm, 300.0, 1e-9);
}

TEST(Travel, TurnsArcsWithTheWorkCoordinates) {
  Move quarter = arc(0.0, 10.0, 1);  // from 0° to 90°, turned: from 90° to 180°
  quarter.rotation_deg = 90.0;
  EXPECT_NEAR(reach_of(quarter, 0).low_mm, 90.0, 1e-9);
  EXPECT_NEAR(reach_of(quarter, 0).high_mm, 100.0, 1e-9);
  EXPECT_NEAR(reach_of(quarter, 1).high_mm, 210.0, 1e-9);
}

/// The passes go down to Z-1; the correction is -20 um from 2 min on and -15 um from 3 min on.
class TravelOfAProgram : public ::testing::Test {
 protected:
  TravelOfAProgram() {
    shop_.settings.window_s = 30.0;
    shop_.config.start_known = true;
    shop_.config.work_offset[0][2] = -50.0;
  }
  void to(double min_mm) { shop_.machine.axes[2].min_au = min_mm; }
  Workshop shop_;
};

TEST_F(TravelOfAProgram, IsKeptToTheMicrometre) {
  // Z−1 with an offset of −50 and a correction of −0.020: −51.020 is just allowed, 0.1 um less is
  // not.
  to(-51.020);
  EXPECT_TRUE(shop_.compensate(kPasses, kGrowth));
  to(-51.0199);
  write_file(shop_.changed(), "as it was\n");
  const auto refused = shop_.compensate(kPasses, kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 15U);  // G1 Z-1 of the third pass
  EXPECT_THAT(refused.error().file, HasSubstr("original.nc"));
  EXPECT_THAT(refused.error().what,
              HasSubstr("the correction takes Z to -51.0200 mm, past the end of its travel at "
                        "-51.0199 mm; without it Z goes to -51.0000 mm"));
  EXPECT_EQ(text_of_file(shop_.changed()), "as it was\n");
}

TEST_F(TravelOfAProgram, IsTheProgramsOwnAffairWhereItIsOverWithoutACorrection) {
  to(-50.5);
  // Half a millimetre too far without any correction: the control deals with that.
  EXPECT_TRUE(shop_.compensate(kPasses, kGrowth));
}

TEST_F(TravelOfAProgram, IsNotWatchedWhereTheOffsetsAreNotKnown) {
  to(-51.0199);
  shop_.config.start_known = false;
  EXPECT_TRUE(shop_.compensate(kPasses, kGrowth));
}

TEST_F(TravelOfAProgram, IsKeptByCorrectionsBesideTheProgram) {
  shop_.config.dialect = read::Dialect::sinumerik;
  shop_.settings.method = Method::r_parameter;
  // The PLC's shift is invisible in the program but takes the axis just as far.
  const std::string program = replaced(replaced(kPasses, "%\nG21", "G71"), "M30\n%\n", "M30\n");
  to(-51.020);
  EXPECT_TRUE(shop_.compensate(program, kGrowth));
  to(-51.0199);
  const auto refused = shop_.compensate(program, kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 11U);  // from where the machine is when the PLC moves it
  EXPECT_THAT(refused.error().what, HasSubstr("takes Z to -51.0200 mm"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
