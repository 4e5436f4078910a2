// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/rewrite/replace/feed_blocks.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;
using test::Workshop;
using test::write_file;

/// A program, its path and its blocks.
struct Part {
  explicit Part(const std::string& program, double merge_share = 0.0) : text(program) {
    shop.machine.control.merge_share = merge_share;
    write_file(shop.original(), program);
    plan::PathBuilder builder(shop.machine);
    const auto report = interpret::run_file(shop.original(), shop.config, builder);
    EXPECT_TRUE(report.has_value() && report->refused.empty());
    path = builder.take().value();
    blocks = cut_blocks(shop.original(), shop.config).value();
  }
  /// The lines that replace, from these feeds; segments that are not named keep theirs.
  [[nodiscard]] NewLines lines(const std::vector<FeedStretch>& named) const {
    std::vector<FeedStretch> all;
    const auto uses = feed_uses(path, blocks);
    for (std::uint32_t i = 0; i < uses.size(); ++i) {
      const std::size_t before = all.size();
      for (const FeedStretch& one : named) {
        if (one.segment == i) {
          all.push_back(one);
        }
      }
      if (all.size() == before && uses[i] != FeedUse::kept) {
        all.push_back({i, 0.0, path.segments[i].length_mm, 1.0});
      }
    }
    return feed_lines(shop.original(), Dialect::linuxcnc, path, blocks, all).value();
  }
  [[nodiscard]] Replaced changed(const NewLines& lines) const {
    return replace(shop.original(), Dialect::linuxcnc, lines, {{"changes", "feeds"}}).value();
  }
  /// Empty when the proof holds; else what it says.
  [[nodiscard]] std::string fault(const Replaced& of) const {
    const auto proof = prove_made(shop.original(), of, shop.config, shop.machine);
    return proof ? "" : proof.error().what;
  }

  Workshop shop;
  std::string text;
  plan::PlannedPath path;
  CutBlocks blocks;
};

const std::string kHead = "G21 G90 G94 G17 G61\nG0 X0 Y0 Z1\n";  // lines 1 and 2

TEST(FeedBlocks, DividesALineAndAnArcWhereTheFeedChanges) {
  const Part part(kHead + "G1 X10 F1000\nG3 X20 Y10 I0 J10\nG0 Z5\nM2\n");
  const NewLines lines = part.lines(
      {{1, 0.0, 4.0, 1.0}, {1, 4.0, 10.0, 0.5}, {2, 0.0, 5.0, 0.5}, {2, 5.0, 15.8, 0.25}});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines.at(3), (std::vector<std::string>{"G1 X4.0 F1000.0", "G1 X10.0 F500.0"}));
  ASSERT_EQ(lines.at(4).size(), 3U);
  // 5 mm on a radius of 10 mm: half a radian.
  EXPECT_EQ(lines.at(4)[0], "G3 X14.79426 Y1.22417 I0.0 J10.0 F500.0");
  EXPECT_EQ(lines.at(4)[1], "G3 X20.0 Y10.0 I-4.79426 J8.77583 F250.0");
  EXPECT_EQ(lines.at(4)[2], "F1000.0");  // the next program finds F as it was
  EXPECT_EQ(part.fault(part.changed(lines)), "");
}

TEST(FeedBlocks, WritesFOnlyWhereItChanges) {
  const Part part(kHead + "G1 X10 F1000\nX20\nX30\nX40 F800\nX50\nM2\n");
  const NewLines lines = part.lines({{2, 0.0, 10.0, 0.5}, {3, 0.0, 10.0, 0.5}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.at(4), (std::vector<std::string>{"X20 F500.0"}));
}

TEST(FeedBlocks, PutsFBackBeforeABlockThatMustStayAndAtTheEnd) {
  const Part part(kHead + "G1 X10 F1000\nX[10+10]\nX30\nM2\n");
  const NewLines lines = part.lines({{1, 0.0, 10.0, 0.5}, {3, 0.0, 10.0, 0.4}});
  EXPECT_EQ(lines.at(3), (std::vector<std::string>{"G1 X10 F500.0", "F1000.0"}));
  EXPECT_EQ(lines.at(5), (std::vector<std::string>{"X30 F400.0", "F1000.0"}));
  EXPECT_EQ(part.fault(part.changed(lines)), "");
}

TEST(FeedBlocks, KeepsBlocksThatMustStay) {
  const Part part(kHead +
                  "G1 X10 F1000\nX[10+10]\nG93 G1 X30 F5\nG94 F900\n/X35\nG2 X40 Y5 I0 J5\nM2\n");
  const auto uses = feed_uses(part.path, part.blocks);
  std::vector<FeedUse> of_cuts;
  for (std::size_t i = 1; i < uses.size(); ++i) {
    of_cuts.push_back(uses[i]);
  }
  using enum FeedUse;
  EXPECT_EQ(of_cuts, (std::vector<FeedUse>{anywhere, kept, kept, kept, kept}));
}

// G64 P0.01 merges the short lines; all of them get the feed of the segment.
TEST(FeedBlocks, GivesMergedLinesOneFeed) {
  const Part part(
      "G21 G90 G94 G17 G64 P0.01\nG0 X0 Y0 Z1\nG1 X10 F1000\nX11 Y0.001\nX12 Y0\nX30 F700\nM2\n",
      1.0);
  ASSERT_EQ(part.path.segments.size(), 3U);
  EXPECT_EQ(feed_uses(part.path, part.blocks)[1], FeedUse::whole);
  const NewLines lines = part.lines({{1, 0.0, 12.0, 0.5}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.at(3), (std::vector<std::string>{"G1 X10 F500.0"}));
}

TEST(FeedBlocks, LeaveARoundedCornerItsShareOfTheBlocks) {
  const Part part("G21 G90 G94 G17 G64 P0.5\nG0 X0 Y0 Z1\nG1 X20 F3000\nY20\nM2\n");
  const auto uses = feed_uses(part.path, part.blocks);
  ASSERT_EQ(uses.size(), 5U);  // rapid, rounding, line, rounding, line
  EXPECT_EQ(uses[3], FeedUse::joined);
  const auto ends = rounding_ends(part.path, part.blocks, 0.5);
  const auto& line = part.path.segments[4];
  const double taken = 20.0 - line.length_mm;
  EXPECT_GT(taken, 0.1);
  EXPECT_NEAR(ends[4][0], 1.05 * taken, 1e-5);
  EXPECT_FLOAT_EQ(ends[4][1], 0.0F);
  EXPECT_NEAR(ends[2][1], 1.05 * taken, 1e-5);
}

RC_GTEST_PROP(FeedBlocks, AnyFeedsAreProvedAndUndone, ()) {
  const Part part(kHead +
                  "N10 G1 X10 F1000\nG3 X20 Y10 I0 J10 (arc)\nG1 Y[10+10]\nX0\nG2 I5 J0\nG20\n"
                  "G1 X1 F40\nY1\nG21 G91 X5 Y5 F600\nG3 X-4 Y4 R4\nG90 G0 Z5\nM2\n");
  const auto uses = feed_uses(part.path, part.blocks);
  std::vector<FeedStretch> stretches;
  for (std::uint32_t i = 0; i < uses.size(); ++i) {
    const double length = part.path.segments[i].length_mm;
    const int pieces = uses[i] == FeedUse::anywhere ? *rc::gen::inRange(1, 4) : 1;
    for (int j = 0; j < pieces && uses[i] != FeedUse::kept; ++j) {
      stretches.push_back(
          {i, length * j / pieces, length * (j + 1) / pieces, 0.1 * *rc::gen::inRange(1, 11)});
    }
  }
  const Replaced changed = part.changed(part.lines(stretches));
  RC_ASSERT(part.fault(changed) == "");
  write_file(part.shop.changed(), changed.text);
  RC_ASSERT(put_back(part.shop.changed())->text == part.text);
}

TEST(SameCut, FindsWhatAChangedProgramDoesOtherwise) {
  const Part part(kHead + "G1 X10 F1000\nG3 X20 Y10 I0 J10\nM8\nG1 Y20\nM2\n");
  const Replaced right = part.changed(part.lines({{1, 0.0, 10.0, 0.5}, {2, 0.0, 15.7, 0.5}}));
  ASSERT_EQ(part.fault(right), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    Replaced wrong = right;
    wrong.text = test::replaced(wrong.text, from, to);
    return part.fault(wrong);
  };
  EXPECT_NE(with("F500.0", "F1500.0"), "");                  // faster than programmed
  EXPECT_NE(with("G1 X10 F500.0", "G1 X10.01 F500.0"), "");  // another end
  EXPECT_NE(with("G1 X10 F500.0", "G0 X10 F500.0"), "");
  EXPECT_NE(with("G1 Y20 F1000.0", "G1 Y20 F1100.0"), "");
  EXPECT_NE(with("M8", "M9"), "");
  EXPECT_NE(with("M2", "G91\nM2"), "");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
