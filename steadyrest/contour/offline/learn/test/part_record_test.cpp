// SPDX-License-Identifier: Apache-2.0
// A part's record as a table: what is read, and what is refused with its line.
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/part_record.hpp>

namespace steadyrest::contour::offline {
namespace {

const std::string kPartHead = "t_s,x_cmd_mm,y_cmd_mm,z_cmd_mm,x_act_mm,y_act_mm,z_act_mm\n";

std::string rows(int count, double period_s = 0.004) {
  std::string out;
  for (int i = 0; i < count; ++i) {
    out +=
        fmt::format("{:.6f},{:.4f},0,-1,{:.4f},0.001,-1\n", i * period_s, 0.1 * i, 0.1 * i - 0.02);
  }
  return out;
}

/// The refusal's whole text; empty where the table is read.
std::string refusal(const std::string& text) {
  const auto record = parse_part_record(text, "part.csv");
  return record ? "" : kernel::outcome::text(record.error());
}

TEST(PartRecord, ReadsCommandsAndEncoders) {
  const auto record = parse_part_record(kPartHead + rows(150), "part.csv").value();
  ASSERT_EQ(record.size(), 150U);
  EXPECT_NEAR(record.period_s, 0.004, 1e-9);
  EXPECT_NEAR(record.time_s[100], 0.4, 1e-9);
  EXPECT_NEAR(record.command_mm[100][0], 10.0, 1e-9);
  EXPECT_NEAR(record.command_mm[100][2], -1.0, 1e-9);
  EXPECT_NEAR(record.actual_mm[100][0], 9.98, 1e-9);
  EXPECT_NEAR(record.actual_mm[100][1], 0.001, 1e-9);
  EXPECT_EQ(record.file, "part.csv");
}

TEST(PartRecord, ColumnsMayStandInAnyOrderAmongOthers) {
  std::string text = "feed,z_act_mm,y_act_mm,x_act_mm,z_cmd_mm,y_cmd_mm,x_cmd_mm,t_s\n";
  for (int i = 0; i < 120; ++i) {
    text += fmt::format("900,6,5,4,3,2,1,{:.3f}\n", 0.01 * i);
  }
  const auto record = parse_part_record(text, "part.csv").value();
  EXPECT_EQ(record.command_mm.front(), (kernel::signal::Point{1, 2, 3}));
  EXPECT_EQ(record.actual_mm.front(), (kernel::signal::Point{4, 5, 6}));
}

// The period is the median step: a gap in the record does not change it.
TEST(PartRecord, AGapDoesNotChangeThePeriod) {
  std::string text = kPartHead + rows(110);
  text += "9.0,11,0,-1,11,0,-1\n";
  EXPECT_NEAR(parse_part_record(text, "part.csv").value().period_s, 0.004, 1e-9);
}

TEST(PartRecord, RefusesWhatIsNoRecord) {
  EXPECT_NE(refusal(kPartHead + rows(99)).find("99 rows"), std::string::npos);
  EXPECT_NE(refusal("").find("part.csv"), std::string::npos);
  EXPECT_NE(refusal("t_s,x_cmd_mm\n0,1\n").find("y_cmd_mm is missing"), std::string::npos);
  EXPECT_NE(refusal("x_cmd_mm,y_cmd_mm\n0,1\n").find("t_s is missing"), std::string::npos);
  const std::string twice = "t_s,x_cmd_mm,x_cmd_mm,y_cmd_mm,z_cmd_mm,x_act_mm,y_act_mm,z_act_mm\n";
  EXPECT_NE(refusal(twice + "0,1,1,1,1,1,1,1\n").find("x_cmd_mm"), std::string::npos);
}

TEST(PartRecord, NamesTheLineOfAFault) {
  const std::string whole = kPartHead + rows(150);
  const std::string back = refusal(whole + "0.1,1,1,1,1,1,1\n");
  EXPECT_NE(back.find("152"), std::string::npos) << back;
  EXPECT_NE(back.find("does not rise"), std::string::npos) << back;
  for (const std::string bad : {"nan", "inf", "", "1e999", "12mm"}) {
    const std::string said = refusal(whole + "0.9,1," + bad + ",1,1,1,1\n");
    EXPECT_NE(said.find("152"), std::string::npos) << bad << ": " << said;
  }
  EXPECT_NE(refusal(whole + "0.9,1,1\n").find("152"), std::string::npos);
}

TEST(PartRecord, RefusesAFileThatIsNotThere) {
  const auto record = read_part_record("no-such-record.csv");
  ASSERT_FALSE(record);
  EXPECT_NE(kernel::outcome::text(record.error()).find("no-such-record.csv"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::contour::offline
