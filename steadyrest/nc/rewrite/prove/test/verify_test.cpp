// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

// Each test spoils a correct pair of programs in one way.
namespace steadyrest::nc::rewrite {
namespace {

using test::kGrowth;
using test::kPasses;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;

const std::string kFirst = test::change_to(-0.01);

class Verify : public ::testing::Test {
 protected:
  void SetUp() override {
    shop_.settings.window_s = 30.0;
    ASSERT_TRUE(shop_.compensate(kPasses, kGrowth));
    text_ = text_of_file(shop_.changed());
  }
  [[nodiscard]] std::string fault(const std::string& text) const {
    return shop_.fault(kGrowth, text);
  }
  /// Moves the first correction to before the first `line`.
  [[nodiscard]] std::string moved_before(const std::string& line) const {
    return replaced(replaced(text_, kFirst, ""), line, kFirst + line);
  }
  Workshop shop_;
  std::string text_;
};

TEST_F(Verify, ProvesWhatIsRight) {
  EXPECT_EQ(fault(text_), "");
  const auto proof = shop_.verify(kGrowth).value();
  EXPECT_EQ(proof.changes, 4U);
  EXPECT_GT(proof.corrected, 10U);
  EXPECT_LT(proof.largest_error_mm, 1e-12);
}

TEST_F(Verify, CatchesAWrongSign) {
  EXPECT_THAT(fault(replaced(text_, "+0.0100]*", "-0.0100]*")),
              HasSubstr("is corrected by 0.010000 mm"));
}

TEST_F(Verify, CatchesAWrongAmount) {
  EXPECT_THAT(fault(replaced(text_, "+0.0100]*", "+0.0101]*")),
              HasSubstr("is corrected by -0.010100 mm"));
}

TEST_F(Verify, CatchesAnAbsoluteValueInTheWorkOffset) {
  // An absolute L2 matches the right value only while the work offset is 0.
  EXPECT_NE(fault(replaced(text_, kFirst, replaced(kFirst, "L20 P0", "L2 P0"))), "");
}

TEST_F(Verify, CatchesAWrongAxis) {
  EXPECT_NE(fault(replaced(text_, kFirst, replaced(kFirst, "P0 Z[#<_z>", "P0 X[#<_x>"))), "");
}

TEST_F(Verify, CatchesAShiftBeforeAnArc) {
  EXPECT_THAT(fault(moved_before("G2 X20")), HasSubstr("no safe place"));
}

TEST_F(Verify, CatchesAShiftThatNeverTakesEffect) {
  EXPECT_THAT(fault(moved_before("G0 X0 Y10")), HasSubstr("has no effect"));
  // In G91 a shift would never act.
  const std::string program = replaced(kPasses, "G0 X0 Y10\n", "G91\nG0 X0 Z1\nG90\nG0 X0 Y10\n");
  ASSERT_TRUE(shop_.compensate(program, kGrowth));
  text_ = text_of_file(shop_.changed());
  EXPECT_EQ(fault(text_), "");
  EXPECT_THAT(fault(moved_before("G0 X0 Z1\n")), HasSubstr("no safe place"));
}

TEST_F(Verify, CatchesAMissingReset) {
  // The last change takes the correction off.
  const auto at = text_.rfind("G10 L20");
  const auto end = text_.find('\n', at) + 1;
  EXPECT_THAT(fault(text_.substr(0, at) + text_.substr(end)), HasSubstr("leaves a different"));
}

TEST_F(Verify, CatchesAMissingCorrection) {
  EXPECT_THAT(fault(replaced(text_, kFirst, "")), HasSubstr("acts at"));
}

TEST_F(Verify, CatchesACorrectionBeyondTheWindow) {
  EXPECT_THAT(fault(moved_before("G0 Z5\n")), HasSubstr("acts at"));
}

TEST_F(Verify, CatchesOneDigitElsewhere) {
  // Text outside the inserted lines: a digit, a line end, an extra line, a missing byte.
  EXPECT_THAT(fault(replaced(text_, "G0 X0 Y30", "G0 X0 Y31")),
              HasSubstr("outside the inserted lines"));
  EXPECT_THAT(fault(replaced(text_, "G1 X100 F100\n", "G1 X100 F100\r\n")),
              HasSubstr("outside the inserted lines"));
  EXPECT_THAT(fault(text_ + "G0 X1\n"), HasSubstr("continues past the end of the original"));
  EXPECT_THAT(fault(text_.substr(0, text_.size() - 1)), HasSubstr("outside the inserted lines"));
}

TEST_F(Verify, CatchesAnInsertedLineThatDoesMore) {
  // Speed, position, feed, mode, and a cut instead of a rapid.
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst + "S99 M3 (STEADYREST Z)\n")), "");
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst + "G0 X1 (STEADYREST Z)\n")), "");
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst + "F1 (STEADYREST Z)\n")), "");
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst + "G91 (STEADYREST Z)\n")), "");
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst + "G1 Z5 (STEADYREST Z)\n")), "");
}

// The next word of the axis would bring it back, so only its own move reveals it.
TEST_F(Verify, CatchesAnInsertedRapidOfThePlannedAxisToWhereThePlanDoesNotWantIt) {
  for (const std::string by : {"+0.005", "-0.005"}) {
    const std::string line = "G0 Z[#<_z>" + by + "] (STEADYREST Z)\n";
    EXPECT_THAT(fault(replaced(text_, "G0 X0 Y10\n", line + "G0 X0 Y10\n")),
                HasSubstr("moves an axis where the plan does not want it"));
  }
}

TEST_F(Verify, CatchesAHeadThatWouldUndoTheWrongWay) {
  const std::string takes_off = "M0 (STEADYREST head Z)\nG10 L20 P0 Z[#<_z>+";
  EXPECT_THAT(fault(replaced(text_, takes_off, replaced(takes_off, "_z>+", "_z>-"))),
              HasSubstr("head"));
}

// They do nothing in an uninterrupted run.
TEST_F(Verify, CatchesAMissingCheckAndAMissingNote) {
  // Their absence shows only after an abort, so only comparing the text finds it.
  const auto check = kFirst.find('\n') + 1;
  const auto note = kFirst.find('\n', check) + 1;
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst.substr(check))), "");
  EXPECT_NE(fault(replaced(text_, kFirst, kFirst.substr(0, note))), "");
  EXPECT_THAT(fault(replaced(text_, kFirst, replaced(kFirst, "=-0.0100", "=-0.0101"))),
              HasSubstr("do not belong here"));
}

// They would do nothing, or nothing yet.
TEST_F(Verify, CatchesLinesThatDoNotBelongHere) {
  const std::string check = kFirst.substr(0, kFirst.find('\n') + 1);
  for (const std::string& line :
       {check, std::string{"(STEADYREST x)\n"}, std::string{"M70 (STEADYREST x)\n"},
        std::string{"M66 P0 L0 (STEADYREST x)\n"}, std::string{"#<mine>=1 (STEADYREST x)\n"},
        std::string{"#<_steadyrest_z>=1 (STEADYREST Z check)\n"}}) {
    EXPECT_THAT(fault(replaced(text_, kFirst, line + kFirst)), HasSubstr("do not belong here"));
    EXPECT_THAT(fault(replaced(text_, kFirst, kFirst + line)), HasSubstr("do not belong here"));
    EXPECT_THAT(fault(replaced(text_, "G0 X0 Y10\n", line + "G0 X0 Y10\n")),
                HasSubstr("do not belong here"));
  }
  EXPECT_THAT(fault(replaced(text_, kFirst, replaced(kFirst, "\n", "\r\n"))), HasSubstr("ends"));
}

TEST_F(Verify, CatchesAHeadElsewhereThanBeforeTheFirstBlock) {
  const auto first = text_.find("#<");
  // After the first block, and before the %.
  const auto block = text_.find("G21 G90");
  const auto next = text_.find('\n', block) + 1;
  EXPECT_THAT(fault(text_.substr(0, first) + text_.substr(block, next - block) +
                    text_.substr(first, block - first) + text_.substr(next)),
              HasSubstr("the head is not before the first block"));
  EXPECT_THAT(
      fault(text_.substr(first, block - first) + text_.substr(0, first) + text_.substr(block)),
      HasSubstr("the head is not before the first block"));
}

TEST_F(Verify, SaysWhatToDoWithAProgramOfAnEarlierVersion) {
  const std::string old_head =
      "o<steadyrest_z1> if [EXISTS[#<_steadyrest_z>]] (STEADYREST head Z)\n";
  test::write_file(shop_.changed(), old_head + kPasses);
  const auto refused = shop_.verify(kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("head"));
  EXPECT_THAT(refused.error().to_do, HasSubstr("compensate it again"));
}

TEST_F(Verify, CatchesAnotherPlan) {
  // Another amount, another time, another axis.
  test::write_file(shop_.changed(), text_);
  EXPECT_FALSE(shop_.verify(replaced(kGrowth, "[0, 10]", "[0, 11]")));
  EXPECT_FALSE(shop_.verify(replaced(kGrowth, "[1, 1]", "[1, 9]")));
  EXPECT_FALSE(shop_.verify(replaced(kGrowth, R"({"tr)", R"({"axis": "X", "tr)")));
}

TEST(VerifyWithKnownTimes, TakesThemForTheLinesThatHaveOneAlone) {
  const Workshop shop;
  const auto made = shop.compensate(kPasses, kGrowth);
  ASSERT_TRUE(made.has_value());
  KnownTimes known{.line_s = {}, .program_s = made->program_s};
  for (const Insertion& one : made->insertions) {
    known.line_s.emplace(one.original_line, one.time_s);
  }
  const auto fault = [&shop](const KnownTimes& times) {
    const auto proof =
        rewrite::verify(shop.original(), shop.changed(), parse_plan(kGrowth, "plan.json").value(),
                        shop.config, shop.machine, shop.settings, &times);
    return proof ? "" : proof.error().what;
  };
  EXPECT_EQ(fault(known), "");
  // The proof may not make up a time that it was not given.
  KnownTimes one_less = known;
  one_less.line_s.erase(one_less.line_s.begin());
  EXPECT_NE(fault(one_less).find("was not found before"), std::string::npos);
  KnownTimes late = known;
  late.line_s.rbegin()->second += 200.0;
  EXPECT_NE(fault(late).find("is planned at"), std::string::npos);
  KnownTimes longer = known;
  longer.program_s += 100.0;
  EXPECT_NE(fault(longer).find("the plan is for"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
