// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/spindle_words.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;
using test::Workshop;
using test::write_file;

std::vector<SpindleSpan> spans_of(const Workshop& shop, const std::string& program,
                                  Dialect dialect = Dialect::linuxcnc) {
  write_file(shop.original(), program);
  interpret::Config config = shop.config;
  config.dialect = dialect;
  return spindle_spans(shop.original(), config).value();
}

/// The changed lines, and the proof that nothing else has changed.
NewLines lines_of(const Workshop& shop, const std::string& program, std::vector<double> ratio,
                  Dialect dialect = Dialect::linuxcnc) {
  auto spans = spans_of(shop, program, dialect);
  EXPECT_EQ(spans.size(), ratio.size());
  keep_carried_feeds(spans, ratio);
  NewLines lines = speed_lines(shop.original(), dialect, spans, ratio).value();
  interpret::Config config = shop.config;
  config.dialect = dialect;
  const auto changed = replace(shop.original(), dialect, lines, {{"changes", "speeds"}});
  const auto proof = prove_made(shop.original(), *changed, config, shop.machine);
  EXPECT_TRUE(proof.has_value()) << (proof ? "" : proof.error().what) << "\n" << changed->text;
  return lines;
}

using Lines = std::vector<std::string>;

TEST(SpindleWords, OfALimitAreNone) {
  const Workshop shop;
  const auto spans = spans_of(shop,
                              "G21 G90 G94\nS2000 M3\nG0 X0 Z0\nG92 S2000\nG1 X5 F400\n"
                              "G96 S150\nG92 S1500\nG1 X6\nM30\n",
                              Dialect::fanuc);
  ASSERT_EQ(spans.size(), 3U) << "with the one before any S";
  EXPECT_EQ(spans[1].speed.line, 2U);
  EXPECT_EQ(spans[2].speed.line, 6U);
}

TEST(SpindleWords, OfRigidTappingStay) {
  const Workshop shop;
  const auto spans =
      spans_of(shop, "G21 G90 G94\nG0 X0 Y0 Z9.\nM29 S500\nG84 X0 Y0 Z-5. R2. F500.\nG80\nM30\n",
               Dialect::fanuc);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[1].stays, "line 4 taps or cuts a thread");
}

TEST(SpindleWords, ScaleTheFeedWithTheSpeed) {
  const Workshop shop;
  const NewLines lines = lines_of(shop,
                                  "G21 G90 G94\nS5000 M3\nG0 X0 Z0 (S1 F2)\nG1 X5 F400\nX6\n"
                                  "F 300.5 ; F1\nX7\nM2\n",
                                  {1.0, 1.1});
  EXPECT_EQ(lines.at(2), Lines{"S5500 M3"});
  EXPECT_EQ(lines.at(4), Lines{"G1 X5 F440"});
  EXPECT_EQ(lines.at(6), Lines{"F330.55 ; F1"});
  EXPECT_EQ(lines.size(), 3U);
}

TEST(SpindleWords, LeaveAFeedPerRevolution) {
  const Workshop shop;
  const NewLines lines =
      lines_of(shop, "G21 G90 G95\nS1000 M3\nG0 X0 Z0\nG1 X5 F0.2\nM2\n", {1.0, 0.8});
  EXPECT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.at(2), Lines{"S800 M3"});
}

// The second S takes the feed over: it is said again for its own speed.
TEST(SpindleWords, SayACarriedFeedAgain) {
  const Workshop shop;
  const NewLines lines = lines_of(
      shop, "G21 G90 G94\nS5000 M3\nG0 X0 Z0\nG1 X5 F400\nS6000\nX6\nM2\n", {1.0, 1.1, 1.0});
  EXPECT_EQ(lines.at(5), Lines{"S6000 F400"});
}

TEST(SpindleWords, KeepASpeedWhoseFeedIsTakenOverByOneThatMustStay) {
  const Workshop shop;
  auto spans =
      spans_of(shop, "G21 G90 G94\n#1=6000\nS5000 M3\nG0 X0 Z0\nG1 X5 F400\nS#1\nX6\nM2\n");
  ASSERT_EQ(spans.size(), 3U);
  std::vector<double> ratio{1.0, 1.1, 1.0};
  keep_carried_feeds(spans, ratio);
  EXPECT_EQ(ratio[1], 1.0);
  EXPECT_EQ(spans[1].stays, "line 6 takes its feed over and must stay");
}

TEST(SpindleWords, SayWhyASpeedMustStay) {
  const Workshop shop;
  const std::string head = "G21 G90 G94\n";
  const auto reason = [&](const std::string& program, Dialect dialect = Dialect::linuxcnc) {
    return spans_of(shop, head + program, dialect).back().stays;
  };
  EXPECT_EQ(reason("S5000 M3\nG1 X5 F400\nM2\n"), "");
  EXPECT_NE(reason("#1=3\nS[5000+#1] M3\nG1 X5 F400\nM2\n"), "");
  EXPECT_NE(reason("/S5000 M3\nG1 X5 F400\nM2\n"), "");
  EXPECT_NE(reason("S5000 M3\nG1 X5 F[400]\nM2\n").find("the feed of line 3"), std::string::npos);
  EXPECT_NE(reason("S500 M3\nG0 X0 Z0\nG33 Z-5 K1\nM2\n").find("thread"), std::string::npos);
  EXPECT_NE(reason("S500 M3\nG1 X1 F400\nG93 X5 F4\nM2\n").find("line 4"), std::string::npos);
  EXPECT_NE(reason("o1 repeat [2]\nS5000 M3\nG1 X5 F400\no1 endrepeat\nM2\n"), "");
}

TEST(SpindleWords, KnowACutUnderG96) {
  const Workshop shop;
  const auto spans =
      spans_of(shop, "G21 G90 G18 G95\nG96 D3000 S200 M3\nG0 X20 Z0\nG1 Z-5 F0.2\nM2\n");
  EXPECT_TRUE(spans.back().surface_speed);
}

// On a sinumerik F and S of G4 are a time and turns, and no feed and no speed.
TEST(SpindleWords, AreNoDwells) {
  const Workshop shop;
  const NewLines lines =
      lines_of(shop, "N10 G71 G90 G94 S5000 M3\nN20 G4 F1\nN30 G4 S2\nN40 G1 X5 F500\nN50 M30\n",
               {1.0, 1.2}, Dialect::sinumerik);
  EXPECT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines.at(4), Lines{"N40 G1 X5 F600"});
}

TEST(SpindleWords, AreFoundOutsideComments) {
  EXPECT_EQ(with_word(Dialect::fanuc, "(S1) N10 s 500 M3 (S2)", "S600"), "(S1) N10 S600 M3 (S2)");
  EXPECT_EQ(with_word(Dialect::sinumerik, "S=500 M3 ;S2", "S600"), "S600 M3 ;S2");
  EXPECT_EQ(with_word(Dialect::linuxcnc, "X5  (end)", "F3"), "X5  (end) F3");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
