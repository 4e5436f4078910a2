// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::kGrowth;
using test::kPasses;
using test::one_step;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using ::testing::HasSubstr;

struct Case {
  const char* unsafe;
  const char* program;
};

TEST(Compensate, PutsEveryCorrectionBeforeAnAbsoluteRapidOfItsAxis) {
  const Workshop shop;
  const auto done = shop.compensate(kPasses, kGrowth).value();
  ASSERT_EQ(done.insertions.size(), 3U);
  const std::string text = text_of_file(shop.changed());
  // Between the passes `G0 Z5` and `G0 Z2` program Z; the nearest to 60 s, 120 s, 180 s is taken.
  for (const auto& one : done.insertions) {
    EXPECT_EQ(one.site, Site::rapid);
    EXPECT_LT(std::abs(one.time_s - one.planned_s), 15.0);
  }
  EXPECT_NEAR(done.insertions[0].delta_um, -10.0, 1e-9);
  EXPECT_NEAR(done.insertions[2].delta_um, 5.0, 1e-9);
  EXPECT_NEAR(done.insertions[2].total_um, -15.0, 1e-9);
  EXPECT_THAT(text, HasSubstr(test::change_to(-0.01)));
  EXPECT_THAT(text, HasSubstr("(STEADYREST Z0.0000 mm)\nM30"));
}

TEST(Compensate, TellsTheLineInTheChangedProgram) {
  const Workshop shop;
  const auto done = shop.compensate(kPasses, kGrowth).value();
  const std::string text = text_of_file(shop.changed());
  for (const auto& one : done.insertions) {
    std::size_t at = 0;
    for (std::uint32_t line = 1; line < one.line; ++line) {
      at = text.find('\n', at) + 1;
    }
    EXPECT_EQ(text.compare(at, 17, "#<_steadyrest_z>="), 0) << one.line;
  }
}

TEST(Compensate, MovesTheAxisAgainstTheDisplacement) {
  const Workshop shop;
  ASSERT_TRUE(shop.compensate(kPasses, kGrowth));
  // Without our own proof: the last pass is cut at −1 − 0.015 mm in machine coordinates.
  struct Lowest final : interpret::Sink {
    void on_move(const interpret::Move& move) override {
      if (move.end[0] == 100.0) {
        depth.push_back(move.end[2] + move.offset[2]);
      }
    }
    void on_event(const interpret::Event& /*event*/) override {}
    std::vector<double> depth;
  } sink;
  ASSERT_TRUE(interpret::run_file(shop.changed(), shop.config, sink));
  ASSERT_GE(sink.depth.size(), 4U);
  EXPECT_NEAR(sink.depth[0], -1.0, 1e-12);
  EXPECT_THAT(sink.depth, ::testing::Contains(::testing::DoubleNear(-1.010, 1e-12)));
  EXPECT_THAT(sink.depth, ::testing::Contains(::testing::DoubleNear(-1.020, 1e-12)));
  EXPECT_THAT(sink.depth, ::testing::Contains(::testing::DoubleNear(-1.015, 1e-12)));
}

TEST(Compensate, RestatesTheAxisAtAClearanceWhereItIsNotProgrammed) {
  Workshop shop;
  shop.settings.window_s = 20.0;
  // No line programs Z near 60 s: only the clearance between two rapids remains.
  const std::string program =
      "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\nG0 Y10\nG0 X0\nG1 X100\nG0 Z20\nM2\n";
  const auto done = shop.compensate(program, one_step(1.0, 1.05, 10)).value();
  ASSERT_EQ(done.insertions.size(), 1U);
  EXPECT_EQ(done.insertions[0].site, Site::clearance);
  EXPECT_EQ(done.proof.added, 1U);
  EXPECT_THAT(text_of_file(shop.changed()), HasSubstr("G0 Z5.0000 (STEADYREST restated)\nG0 X0"));
}

// The axis' position is unknown there: any number would move it by the work offset.
TEST(Compensate, RestatesNoAxisThatTheProgramHasNotSentToItsPlace) {
  const Case cases[] = {
      {"never moved", "G21 G90 G94 G54\nG0 X0\nG1 X100 F100\nG0 Y10\nG0 X0\nG1 X100\nM2\n"},
      {"by machine coordinates",
       "G21 G90 G94 G54\nG53 G0 Z0\nG1 X100 F100\nG0 Y10\nG0 X0\nG1 X100\nM2\n"},
      {"another work offset",
       "G21 G90 G94 G54\nG0 Z5\nG55\nG1 X100 F100\nG0 Y10\nG0 X0\nG1 X100\nM2\n"},
  };
  for (const Case& one : cases) {
    Workshop shop;
    shop.settings.window_s = 20.0;
    const auto refused = shop.compensate(one.program, one_step(1.0, 1.0, 10));
    ASSERT_FALSE(refused) << one.unsafe;
    EXPECT_THAT(refused.error().what, HasSubstr("no safe place")) << one.unsafe;
  }
}

TEST(Compensate, TurnsTheCorrectionOverWhenTheWorkOffsetChanges) {
  Workshop shop;
  shop.config.work_offset[1][2] = 7.5;
  const std::string program = replaced(kPasses, "G0 X0 Y20\n", "G55\nG0 X0 Y20\n");
  const auto done = shop.compensate(program, kGrowth).value();
  const std::string text = text_of_file(shop.changed());
  // Nine lines of head for each of three axes; three changes of three lines; at G55 two off and
  // three on; two at the end.
  EXPECT_EQ(done.inserted_lines, 27U + 9U + 5U + 2U);
  EXPECT_THAT(text, HasSubstr("(STEADYREST Z0.0000 mm)\nG55\n" + test::change_to(-0.02)));
}

// Each of these makes the only place near the instant unsafe.
TEST(Compensate, NeverWritesWhereAShiftWouldNotBeSafe) {
  const Case kCases[] = {
      {"G91", "G21 G90 G94 G54\nG0 Z5\nG91\nG1 X100 F100\nG0 Z5\nG1 X100\nG90\nM2\n"},
      {"cycle",
       "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\nG81 X1 Z-1 R2 F900\nG0 Z5\nG81 X2 Z-1 R2\n"
       "G80\nG1 X102 F100\nM2\n"},
      {"loop",
       "G21 G90 G94 G54\nG0 Z5\no1 repeat [2]\nG0 Z5\nG1 X100 F100\nG0 Z5\nG1 X0\no1 endrepeat\n"
       "M2\n"},
      {"arcs", "G21 G90 G94 G17 G54\nG0 X0 Y0 Z5\nG2 X20 I10 F60\nG1 Z4\nG2 X40 I10\nM2\n"},
      {"G93", "G21 G90 G94 G54\nG0 Z5\nG93 G1 X100 F1\nG0 Z5\nG1 X0 F1\nG94\nM2\n"},
      {"G53", "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\nG53 G0 Z5\nG1 X0\nM2\n"},
      {"before G43", "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\nT1 M6\nG0 Z5\nG43 H1\nG1 X0\nM2\n"},
      {"block delete", "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\n/G0 Z5\nG1 X0\nM2\n"},
      {"condition",
       "G21 G90 G94 G54\nG0 Z5\nG1 X100 F100\no1 if [1]\nG0 Z5\no1 endif\nG1 X0\nM2\n"},
  };
  for (const Case& one : kCases) {
    Workshop shop;
    shop.settings.window_s = 20.0;
    // The window is so narrow that only the line in question is in it.
    shop.machine.control.tool_change_s = 0.5;
    const double minutes = std::string(one.unsafe) == "arcs" ? 0.52 : 1.0;
    const double total = std::string(one.unsafe) == "loop" ? 3.0 : minutes;
    const auto refused = shop.compensate(one.program, one_step(minutes, total, 10));
    ASSERT_FALSE(refused) << one.unsafe << "\n" << text_of_file(shop.changed());
    EXPECT_THAT(refused.error().what, HasSubstr("no safe place")) << one.unsafe;
    EXPECT_FALSE(std::filesystem::exists(shop.changed()));
  }
}

TEST(Compensate, MayReplaceTheProgramItself) {
  const Workshop shop;
  test::write_file(shop.original(), kPasses);
  const auto plan = parse_plan(kGrowth, "plan.json").value();
  ASSERT_TRUE(
      compensate(shop.original(), shop.original(), plan, shop.config, shop.machine, shop.settings));
  EXPECT_THAT(text_of_file(shop.original()), HasSubstr("STEADYREST"));
  ASSERT_TRUE(strip(shop.original(), shop.original()));
  EXPECT_EQ(text_of_file(shop.original()), kPasses);
}

TEST(Compensate, APlanThatCorrectsNothingCopiesTheProgram) {
  const Workshop shop;
  const auto done =
      shop.compensate(kPasses, R"({"transitions": [{"n": 1, "t_min": [4.2], "delta_um": [0]}]})");
  ASSERT_TRUE(done);
  EXPECT_EQ(text_of_file(shop.changed()), kPasses);
}

TEST(Compensate, FollowsAnOffsetThatTheProgramSetsItself) {
  Workshop shop;
  for (const std::string line : {"G92 Z4", "G10 L20 P0 Z4", "G52 Z1"}) {
    const std::string program =
        replaced(kPasses, "G0 X0 Y20\n", "G0 X0 Y20\n" + line + "\nG0 Z6\n");
    const auto done = shop.compensate(program, kGrowth);
    ASSERT_TRUE(done) << line << ": " << done.error().what;
    EXPECT_THAT(text_of_file(shop.changed()), HasSubstr(" (STEADYREST Z noted)\nG0 Z6")) << line;
  }
  const std::string in_loop = "o1 repeat [2]\nG92 Z4\no1 endrepeat\nG0 Z6\n";
  // A loop executes the line twice, so nothing may be written around it.
  EXPECT_FALSE(shop.compensate(replaced(kPasses, "G0 X0 Y20\n", "G0 X0 Y20\n" + in_loop), kGrowth));
}

// The control's offsets leave a rounding error in the correction found.
TEST(Compensate, ProvesCorrectionsThatCancelWhateverTheOffsetsAre) {
  Workshop shop;
  shop.settings.window_s = 30.0;
  shop.config.start_known = true;
  shop.config.work_offset[0] = {0.1, -7.3, 1.0514 * 25.4};
  const std::string plan = R"({"transitions": [{"n": 2, "t_min": [1, 1], "delta_um": [0, 74.1]},)"
                           R"( {"n": 2, "t_min": [1, 1.2], "delta_um": [-74.1, 0.3]}]})";
  const auto done = shop.compensate(kPasses, plan);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(done->proof.changes, 4U);
}

TEST(Compensate, SparesTheSubprogramsThatItCalls) {
  Workshop shop;
  // The output is a link to the called file: writing it would destroy what the program calls.
  shop.config.subprogram_folders = {shop.folder()};
  const std::string file = shop.folder() + "/coolant.ngc";
  const std::string text = "o<coolant> sub\nM8\no<coolant> endsub\nM2\n";
  test::write_file(file, text);
  std::filesystem::create_symlink(file, shop.changed());
  const std::string program =
      replaced(kPasses, "G0 X0 Y0 Z20\n", "G0 X0 Y0 Z20\no<coolant> call\n");
  const auto refused = shop.compensate(program, kGrowth);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("coolant.ngc"));
  EXPECT_EQ(text_of_file(file), text);
  std::filesystem::remove(shop.changed());
  const auto done = shop.compensate(program, kGrowth);
  EXPECT_TRUE(done) << done.error().what;
}

TEST(Compensate, APlanWithoutCorrectionsLeavesItsMark) {
  Workshop shop;
  shop.settings.told = {{.name = "window-s", .value = "60"}};
  const std::string plan = R"({"transitions": [{"n": 2, "t_min": [2, 2.2], "delta_um": [0, 0]}]})";
  ASSERT_TRUE(shop.compensate(kPasses, plan));
  EXPECT_EQ(text_of_file(shop.changed()),
            replaced(kPasses, "%\n", "%\n" + mark_text(Way{}, shop.settings.told, "\n")));
  EXPECT_TRUE(shop.verify(plan));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
