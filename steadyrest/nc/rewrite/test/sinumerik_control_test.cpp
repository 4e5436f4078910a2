// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

// The two SINUMERIK methods other than the R-parameter.
namespace steadyrest::nc::rewrite {
namespace {

using test::kGrowth;
using test::kPasses;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;
using ::testing::Not;

// DEF must stay before the head (alarm 14500).
const std::string kProgram =
    replaced(replaced(kPasses, "%\nG21", "DEF REAL DEPTH=-1 ;mm\nG71"), "M30\n%\n", "M30\n");

class OfSinumerik : public ::testing::Test {
 protected:
  explicit OfSinumerik(Method method) {
    shop_.settings.method = method;
    shop_.settings.window_s = 30.0;
    shop_.config.dialect = read::Dialect::sinumerik;
  }
  /// The changed text.
  std::string write(const std::string& program = kProgram) {
    const auto done = shop_.compensate(program, kGrowth);
    EXPECT_TRUE(done) << done.error().what << " " << done.error().line;
    return done ? text_of_file(shop_.changed()) : std::string{};
  }
  /// Why the program is refused.
  std::string refusal(const std::string& program) {
    const auto done = shop_.compensate(program, kGrowth);
    return done ? "" : done.error().what;
  }
  void expect_stripped(const std::string& program) {
    ASSERT_TRUE(strip(shop_.changed(), shop_.changed()));
    EXPECT_EQ(text_of_file(shop_.changed()), program);
  }
  Workshop shop_;
};

class SettingData : public OfSinumerik {
 protected:
  SettingData() : OfSinumerik(Method::setting_data) { shop_.settings.cleared_after_abort = true; }
};

TEST_F(SettingData, IsWrittenWithTheSignThatTheMachineHas) {
  std::string text = write();
  EXPECT_THAT(text, HasSubstr("DEF REAL DEPTH=-1 ;mm\n"
                              "$SA_TEMP_COMP_ABS_VALUE[Z]=0.0000 ;STEADYREST head Z\nG71"));
  EXPECT_THAT(text, HasSubstr("STOPRE ;STEADYREST Z-0.0100 mm\n"
                              "$SA_TEMP_COMP_ABS_VALUE[Z]=-0.0100 ;STEADYREST Z-0.0100 mm\n"));
  EXPECT_THAT(text, HasSubstr("$SA_TEMP_COMP_ABS_VALUE[Z]=0.0000 ;STEADYREST Z0.0000 mm\nM30"));
  EXPECT_EQ(shop_.verify(kGrowth).value().changes, 4U);
  expect_stripped(kProgram);
  // A machine on which a positive value moves the axis down: only the value's sign changes, not the
  // comment.
  shop_.settings.sign = -1;
  text = write();
  EXPECT_THAT(text, HasSubstr("$SA_TEMP_COMP_ABS_VALUE[Z]=0.0100 ;STEADYREST Z-0.0100 mm\n"));
  EXPECT_THAT(text, HasSubstr("$SA_TEMP_COMP_ABS_VALUE[Z]=0.0000 ;STEADYREST Z0.0000 mm\nM30"));
  expect_stripped(kProgram);
}

TEST_F(SettingData, AsksBeforeItIsTakenOffWhereSomebodyMayHaveTouchedOff) {
  shop_.settings.cleared_after_abort = false;
  EXPECT_THAT(write(), HasSubstr("set the temperature compensation to 0, touch off again\") "
                                 ";STEADYREST head Z\nM0 ;STEADYREST head Z\n"));
  EXPECT_TRUE(shop_.verify(kGrowth));
  expect_stripped(kProgram);
}

TEST_F(SettingData, VerifyCatchesEachFault) {
  const std::string text = write();
  const std::string first = "$SA_TEMP_COMP_ABS_VALUE[Z]=-0.0100";
  // Wrong sign, wrong axis, wrong variable, wrong kind.
  for (const char* wrong :
       {"$SA_TEMP_COMP_ABS_VALUE[Z]=0.0100", "$SA_TEMP_COMP_ABS_VALUE[Y]=-0.0100",
        "$SA_TEMP_COMP_SLOPE[Z]=-0.0100", "R0=-0.0100"}) {
    EXPECT_THAT(shop_.fault(kGrowth, replaced(text, first, wrong)),
                HasSubstr("no step of the plan"));
  }
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, "STOPRE ;STEADYREST Z-0.0100 mm\n", "")),
              HasSubstr("no step of the plan"));
  EXPECT_THAT(
      shop_.fault(kGrowth, replaced(text, "=0.0000 ;STEADYREST head", "=1 ;STEADYREST head")),
      HasSubstr("head"));
  shop_.settings.sign = -1;
  EXPECT_NE(shop_.fault(kGrowth, text), "");
}

TEST_F(SettingData, RefusesAProgramThatWritesItItself) {
  EXPECT_THAT(
      refusal(replaced(kProgram, "G0 X0 Y30\n", "$SA_TEMP_COMP_ABS_VALUE[X]=0\nG0 X0 Y30\n")),
      HasSubstr("uses the temperature compensation itself"));
  // In small letters, another of its family, after a `;` in quotes.
  for (const char* line : {"$sa_temp_comp_abs_value[Z]=0", "$MA_TEMP_COMP_TYPE[Z]=0",
                           "MSG(\"a;b\") $SA_TEMP_COMP_SLOPE[Z]=0"}) {
    EXPECT_NE(refusal(replaced(kProgram, "G0 X0 Y30\n", line + std::string{"\nG0 X0 Y30\n"})), "")
        << line;
  }
  EXPECT_EQ(refusal(replaced(kProgram, "G0 X0 Y30\n", "G0 X0 Y30 ;$SA_TEMP_COMP_ABS_VALUE\n")), "");
}

class FrameFine : public OfSinumerik {
 protected:
  FrameFine() : OfSinumerik(Method::frame_fine) {}
};

const std::string kStored = "$P_IFRAME[Z,FI]=$P_UIFR[$P_UIFRNUM,Z,FI]";

TEST_F(FrameFine, IsWrittenFromWhatIsStored) {
  const std::string text = write();
  EXPECT_THAT(text, HasSubstr(";mm\n" + kStored + " ;STEADYREST head Z\nG71"));
  EXPECT_THAT(text, HasSubstr(kStored + "-0.0100 ;STEADYREST Z-0.0100 mm\n"));
  EXPECT_THAT(text, HasSubstr(kStored + " ;STEADYREST Z0.0000 mm\nM30"));
  EXPECT_THAT(text, Not(HasSubstr("(STEADYREST")));
  const auto proof = shop_.verify(kGrowth);
  ASSERT_TRUE(proof) << proof.error().what;
  EXPECT_GT(proof->corrected, 10U);
  EXPECT_LT(proof->largest_error_mm, 1e-9);
  expect_stripped(kProgram);
}

TEST_F(FrameFine, IsWrittenAgainWhereAFrameIsTakenAnew) {
  shop_.config.work_offset[1][2] = -3.0;
  // Each of these loads the stored frame, which lacks the correction.
  for (const std::string word : {"G54", "G55", "G500"}) {
    const std::string program = replaced(kProgram, "G0 X0 Y30\n", word + "\nG0 X0 Y30\n");
    EXPECT_THAT(write(program),
                HasSubstr(kStored + " ;STEADYREST Z0.0000 mm\n" + word + "\n" + kStored + "-0.0"))
        << word;
    ASSERT_TRUE(shop_.verify(kGrowth));
    expect_stripped(program);
  }
}

TEST_F(FrameFine, LeavesTheProgrammedFrame) {
  const std::string program = replaced(kProgram, "G0 X0 Y0 Z20\n", "TRANS Z=-2\nG0 X0 Y0 Z20\n");
  write(program);
  const auto proof = shop_.verify(kGrowth);
  ASSERT_TRUE(proof) << proof.error().what;
  expect_stripped(program);
}

TEST_F(FrameFine, VerifyCatchesEachFault) {
  const std::string text = write();
  const std::string first = kStored + "-0.0100";
  // Sign, amount, none, another variable, absolute, coarse, wrong axis, wrong source, stored frame,
  // programmed frame.
  for (const std::string& wrong :
       {kStored + "+0.0100", kStored + "-0.0101", kStored + " ", std::string("R1=-0.0100"),
        std::string("$P_IFRAME[Z,FI]=-0.0100"), std::string("$P_IFRAME[Z,TR]=-0.0100"),
        std::string("$P_IFRAME[Y,FI]=$P_UIFR[$P_UIFRNUM,Y,FI]-0.0100"),
        std::string("$P_IFRAME[Z,FI]=$P_UIFR[$P_UIFRNUM,Y,FI]-0.0100"),
        std::string("$P_UIFR[1,Z,FI]=-0.0100"), std::string("ATRANS Z=-0.0100")}) {
    EXPECT_NE(shop_.fault(kGrowth, replaced(text, first, wrong)), "") << wrong;
  }
  const auto line = [&](const std::string& value) {
    return kStored + value + " ;STEADYREST Z" + (value.empty() ? "0.0000" : value) + " mm\n";
  };
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, line("-0.0100"), "")), "");
  EXPECT_NE(shop_.fault(kGrowth, replaced(text, line(""), "")), "");
  EXPECT_NE(shop_.fault(kGrowth, replaced(replaced(text, line("-0.0200"), ""), "G2 X20",
                                          line("-0.0200") + "G2 X20")),
            "");
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, kStored + " ;STEADYREST head Z\n", "")),
              HasSubstr("head"));
}

TEST_F(FrameFine, VerifyRefusesAProgramThatWritesItItself) {
  const std::string text = write();
  const std::string own = "$P_IFRAME[Y,FI]=0\nG71";
  test::write_file(shop_.original(), replaced(kProgram, "G71", own));
  EXPECT_THAT(shop_.fault(kGrowth, replaced(text, "G71", own)),
              HasSubstr("uses the frames' variables itself"));
}

TEST_F(FrameFine, RefusesInchesAndProgramsWithFramesOfTheirOwn) {
  EXPECT_THAT(refusal(replaced(kProgram, "G0 X0 Y30\n", "$P_UIFR[1,X,TR]=0\nG0 X0 Y30\n")),
              HasSubstr("uses the frames' variables itself"));
  EXPECT_THAT(
      refusal(replaced(kProgram, "G0 X0 Y30\n", "MSG(\";\") $P_UIFR[1,Z,FI]=0\nG0 X0 Y30\n")),
      HasSubstr("uses the frames' variables itself"));
  const auto done = shop_.compensate(
      "G700 G90 G94 G54\nG0 Z1.\nG1 X4. F4.\nG0 Z1.\nG0 X0\nG0 Z.5\nG1 X4. F4.\nG0 Z1.\nM30\n",
      R"({"transitions": [{"n": 2, "t_min": [1, 1.05], "delta_um": [0, 10]}]})");
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, HasSubstr("inch"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
