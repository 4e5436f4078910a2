// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/test/fanuc_shop.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

// The same passes for controls that have no expressions.
namespace steadyrest::nc::rewrite {
namespace {

using test::Fanuc;
using test::kFanuc;
using test::kGrowth;
using test::kPasses;
using test::replaced;
using test::text_of_file;
using ::testing::HasSubstr;
using ::testing::Not;

class Haas : public Fanuc {
 protected:
  Haas() : Fanuc(Method::haas) {}
};

TEST_F(Fanuc, MovesTheExternalOffsetByIncrements) {
  // The amount is incremental, so the sum over the program must be 0: −0.010 … and +0.015 at the
  // end.
  const auto done = shop_.compensate(kFanuc, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  const std::string text = text_of_file(shop_.changed());
  EXPECT_THAT(text, HasSubstr("G91 G10 L2 P0 Z-0.0100 (STEADYREST Z-0.0100 mm)\n"
                              "G90 (STEADYREST Z-0.0100 mm)\n"));
  EXPECT_THAT(text, HasSubstr("G91 G10 L2 P0 Z0.0150 (STEADYREST Z0.0000 mm)\n"
                              "G90 (STEADYREST Z0.0000 mm)\nM30"));
  ASSERT_TRUE(strip(shop_.changed(), shop_.changed()));
  EXPECT_EQ(text_of_file(shop_.changed()), kFanuc);
}

TEST_F(Fanuc, NeedsNoCareWhenTheWorkOffsetChanges) {
  // The external offset acts in every system: no lines around G55.
  shop_.config.work_offset[1][2] = -3.0;
  const std::string program = replaced(kFanuc, "G0 X0 Y20\n", "G55 G0 X0 Y20 Z5\n");
  const auto done = shop_.compensate(program, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(done->inserted_lines, 9U);
}

TEST_F(Fanuc, LeavesG91InForceAtTheEnd) {
  const std::string program = replaced(kFanuc, "M30\n", "G91 G28 Z0\nM30\n");
  const auto done = shop_.compensate(program, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_THAT(text_of_file(shop_.changed()),
              HasSubstr("G91 G28 Z0\nG91 G10 L2 P0 Z0.0150 (STEADYREST Z0.0000 mm)\nM30"));
}

TEST_F(Fanuc, RefusesAProgramThatSetsTheExternalOffsetItself) {
  EXPECT_FALSE(
      shop_.compensate(replaced(kFanuc, "G0 X0 Y30\n", "G10 L2 P0 Z0\nG0 X0 Y30\n"), kGrowth));
}

// 0.0001 inch where the increment is 0.001 mm.
TEST_F(Fanuc, WritesInchesInWholeIncrements) {
  const std::string program =
      "G20 G90 G94\nG0 Z1.\nG1 X4. F4.\nG0 Z1.\nG0 X0\nG0 Z.5\nG1 X4. F4.\nG0 Z1.\nM30\n";
  const std::string plan =
      R"({"transitions": [{"n": 2, "t_min": [1, 1.05], "delta_um": [0, 10]}]})";
  const auto done = shop_.compensate(program, plan);
  ASSERT_TRUE(done) << done.error().what;
  // 10 um are 0.000394 in; in whole 0.0001 in that is 0.0004 in, 10.16 um.
  EXPECT_THAT(text_of_file(shop_.changed()),
              HasSubstr("G10 L2 P0 Z-0.00040 (STEADYREST Z-0.01016"));
  EXPECT_NEAR(done->insertions.at(0).total_um, -10.16, 1e-9);
  shop_.settings.increment_mm = 1e-5;
  ASSERT_TRUE(shop_.compensate(program, plan));
  EXPECT_THAT(text_of_file(shop_.changed()), HasSubstr("G10 L2 P0 Z-0.000394 (STEADYREST"));
}

TEST_F(Fanuc, NeedsTheUnitsSaid) {
  const auto refused = shop_.compensate(replaced(kFanuc, "G21 G90", "G90"), kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("has set its units"));
  EXPECT_THAT(refused.error().to_do, HasSubstr("G21"));
}

TEST_F(Fanuc, RefusesAProgramThatTakesTheCorrectionOffInOtherUnits) {
  const auto refused = shop_.compensate(replaced(kFanuc, "M30\n", "G20\nM30\n"), kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("changes its units"));
}

// The control adds up only whole increments, in whatever order they are written.
RC_GTEST_PROP(Increments, AddUpToNothingAndStayWithinHalfOfOneOfThePlan, ()) {
  // Reads the text back and counts in the control's own unit, as the control would.
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const auto below = [&random](unsigned n) { return static_cast<int>(random() % n); };
  Way way;
  way.method = below(2) == 0 ? Method::fanuc : Method::haas;
  const int grains[] = {1, 10, 100, 25, 1000};
  const int grain = grains[below(5)];
  way.increment_mm = grain * 1e-5;
  const double unit_mm = below(2) == 0 ? 1.0 : 25.4;
  const double increment_mm = way.increment_mm * (unit_mm == 1.0 ? 1.0 : 2.54);
  double stands_mm = 0.0;
  long long counts = 0;
  for (int step = 0; step < 50; ++step) {
    const double wanted_mm = step == 49 ? 0.0 : (below(400'000) - 200'000) * 1e-6;
    const double to_mm = writable_mm(way, unit_mm, wanted_mm);
    RC_ASSERT(std::abs(to_mm - wanted_mm) <= 0.5 * increment_mm + 1e-12);
    const std::string text = change_text(
        way, {.letter = 'Z', .from_mm = stands_mm, .to_mm = to_mm, .unit_mm = unit_mm}, "\n");
    const auto at = text.find(" Z") + 2;
    const std::string digits = text.substr(at, text.find(' ', at) - at);
    // In hundred-thousandths of a millimetre, or millionths of an inch, as the text has it.
    const double read = std::strtod(digits.c_str(), nullptr) * (unit_mm == 1.0 ? 1e5 : 1e6);
    const long long count = std::llround(read);
    RC_ASSERT(std::abs(read - static_cast<double>(count)) < 1e-6);
    RC_ASSERT(count % grain == 0);
    counts += count;
    stands_mm = to_mm;
  }
  RC_ASSERT(counts == 0);
}

TEST_F(Fanuc, VerifyCatchesAMissingG90) {
  ASSERT_TRUE(shop_.compensate(kFanuc, kGrowth));
  const std::string text = text_of_file(shop_.changed());
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, "G90 (STEADYREST Z-0.0100 mm)\n", "")), "");
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, "G91 G10", "G10")), "");
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, "P0 Z-0.0100", "P0 Z0.0100")), "");
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, "P0 Z-0.0100", "P2 Z-0.0100")), "");
}

TEST_F(Haas, MovesTheActiveWorkOffsetAndTurnsItOver) {
  // G55 has another offset: off in G54 before it, on in G55 after it.
  shop_.config.work_offset[1][2] = -3.0;
  const std::string program = replaced(kFanuc, "G0 X0 Y20\n", "G55\nG0 X0 Y20\n");
  const auto done = shop_.compensate(program, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  const std::string text = text_of_file(shop_.changed());
  EXPECT_THAT(text, HasSubstr("G91 G10 L2 P1 Z-0.0100"));
  EXPECT_THAT(text, HasSubstr("\nG55\nG91 G10 L2 P2 Z-0."));
  EXPECT_THAT(text, Not(HasSubstr("P0")));
}

class Sinumerik : public Fanuc {
 protected:
  Sinumerik() : Fanuc(Method::r_parameter) {
    shop_.config.dialect = read::Dialect::sinumerik;
    shop_.settings.r_parameter = 50;
    shop_.settings.cleared_after_abort = true;
  }
  void SetUp() override {
    const auto done = shop_.compensate(kProgram, kGrowth);
    ASSERT_TRUE(done) << done.error().what;
    text_ = text_of_file(shop_.changed());
  }
  const std::string kProgram = replaced(replaced(kPasses, "%\nG21", "G71"), "M30\n%\n", "M30\n");
  std::string text_;
};

TEST_F(Sinumerik, WritesTheParameterWhenTheMachineGetsThere) {
  EXPECT_EQ(text_.substr(0, text_.find('\n')), "R50=0.0000 ;STEADYREST head Z");
  EXPECT_THAT(text_, HasSubstr("STOPRE ;STEADYREST Z-0.0100 mm\nR50=-0.0100 ;STEADYREST"));
  EXPECT_THAT(text_, HasSubstr("R50=0.0000 ;STEADYREST Z0.0000 mm\nM30"));
  EXPECT_EQ(shop_.verify(kGrowth).value().changes, 4U);
  ASSERT_TRUE(strip(shop_.changed(), shop_.changed()));
  EXPECT_EQ(text_of_file(shop_.changed()), kProgram);
}

TEST_F(Sinumerik, AsksBeforeItTakesOffWhereSomebodyMayHaveTouchedOff) {
  shop_.settings.cleared_after_abort = false;
  ASSERT_TRUE(shop_.compensate(kProgram, kGrowth));
  const std::string text = text_of_file(shop_.changed());
  EXPECT_EQ(text.substr(0, text.find("G71")),
            "MSG(\"Z: touched off after an aborted run? Stop, set R50 to 0, touch off again\") "
            ";STEADYREST head Z\nM0 ;STEADYREST head Z\nMSG() ;STEADYREST head Z\n"
            "R50=0.0000 ;STEADYREST head Z\n");
  EXPECT_TRUE(shop_.verify(kGrowth));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, "M0 ;STEADYREST head Z\n", "")),
              HasSubstr("head"));
  ASSERT_TRUE(strip(shop_.changed(), shop_.changed()));
  EXPECT_EQ(text_of_file(shop_.changed()), kProgram);
}

TEST_F(Sinumerik, TheHeadStandsBehindTheNameOfTheProgram) {
  const std::string names = "%_N_PASSES_MPF\n;$PATH=/_N_WKS_DIR/_N_A_WPD\n";
  const auto done = shop_.compensate(names + kProgram, kGrowth);
  ASSERT_TRUE(done) << done.error().what;
  const std::string head = "R50=0.0000 ;STEADYREST head Z\n";
  const std::string text = text_of_file(shop_.changed());
  EXPECT_EQ(text.substr(0, names.size() + head.size()), names + head);
  EXPECT_THAT(shop_.fault(kGrowth, head + replaced(text, head, "")),
              HasSubstr("the head is not before the first block"));
}

TEST_F(Sinumerik, VerifyCatchesEachFault) {
  const std::string first = "STOPRE ;STEADYREST Z-0.0100 mm\nR50=-0.0100 ;STEADYREST Z-0.0100 mm\n";
  const auto moved = [&](const std::string& line) {
    return replaced(replaced(text_, first, ""), line, first + line);
  };
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text_, "R50=-0.0100", "R50=0.0100")),
              HasSubstr("no step of the plan"));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text_, "R50=-0.0100", "R51=-0.0100")),
              HasSubstr("no step of the plan"));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text_, "STOPRE ;STEADYREST Z-0.0100 mm\n", "")),
              HasSubstr("no step of the plan"));
  const std::string second =
      replaced(replaced(first, "0.0100", "0.0200"), "R50=-0.0100 ;STEADYREST Z-0.0100",
               "R50=-0.0200 ;STEADYREST Z-0.0200");
  EXPECT_THAT(
      shop_.fault(kGrowth, replaced(replaced(text_, second, ""), "G2 X20", second + "G2 X20")),
      HasSubstr("not a safe place"));
  EXPECT_THAT(shop_.fault(kGrowth, moved("G1 X100")), HasSubstr("not a safe place"));
  EXPECT_THAT(shop_.fault(kGrowth, moved("G0 Z5")), HasSubstr("acts at"));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text_, "R50=0.0000 ;STEADYREST head Z\n", "")),
              HasSubstr("head"));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text_, "G0 X0 Y30", "G0 X0 Y31")),
              HasSubstr("outside the inserted lines"));
  const auto reset = text_.rfind("STOPRE");
  EXPECT_THAT(shop_.fault(kGrowth, text_.substr(0, reset) + "M30\n"), HasSubstr("left at the end"));
}

TEST_F(Sinumerik, RefusesAProgramThatUsesTheParameterItself) {
  // Spellings that the control reads as R50, or that could be R50.
  for (const char* line : {"R50=1", "R050=1", "X=R50", "N10 G0 X=R1+R50", "r 50=2", "N10R50=1",
                           "R[R1]=3", "X=$R[1]", "Y=-R50*2", "MSG(\"a;b\") R50=2"}) {
    EXPECT_TRUE(uses_parameter(line, 50)) << line;
  }
  for (const char* line :
       {"R5=1", "R500=1", "CR=50", "X=R51 ;R50", "TR50=1", "G0 X50", "MSG(\"a;b\") ;R50"}) {
    EXPECT_FALSE(uses_parameter(line, 50)) << line;
  }
  const auto refused =
      shop_.compensate(replaced(kProgram, "G0 X0 Y30\n", "R50=1\nG0 X0 Y30\n"), kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("R50"));
  EXPECT_EQ(refused.error().line, 18U);
  EXPECT_TRUE(shop_.compensate(replaced(kProgram, "G0 X0 Y30\n", "R51=1\nG0 X0 Y30\n"), kGrowth));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
