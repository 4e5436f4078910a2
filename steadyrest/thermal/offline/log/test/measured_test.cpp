// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/log/measured.hpp>

namespace steadyrest::thermal::offline {
namespace {

std::string fault(const std::string& text) {
  const auto rows = parse_measured(text, "parts.csv");
  return rows ? "" : kernel::outcome::text(rows.error());
}

TEST(Measured, IsReadWithItsUnits) {
  const auto rows = parse_measured(
      "# "
      "bore\n\"part\";time_h;deviation_mm;tolerance_um;axis\r\nA1;0.5;-0.0042;10;Z\r\n\nA2;1;0.001;"
      "12;X\n",
      "parts.csv");
  ASSERT_TRUE(rows) << kernel::outcome::text(rows.error());
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ((*rows)[0].part, "A1");
  EXPECT_EQ((*rows)[0].axis, "Z");
  EXPECT_EQ((*rows)[0].line, 3U);
  EXPECT_DOUBLE_EQ((*rows)[0].time_s, 1800.0);
  EXPECT_DOUBLE_EQ((*rows)[0].deviation_mm, -0.0042);
  EXPECT_DOUBLE_EQ((*rows)[1].tolerance_mm, 0.012);
  const auto by_name = parse_measured("transition,deviation_um\nfinish,3\n", "parts.csv");
  ASSERT_TRUE(by_name);
  EXPECT_EQ((*by_name)[0].transition, "finish");
  EXPECT_DOUBLE_EQ((*by_name)[0].deviation_mm, 0.003);
}

TEST(Measured, RefusesWhatCannotBeRead) {
  EXPECT_NE(fault("").find("no measured part"), std::string::npos);
  EXPECT_NE(fault("part,time_min,deviation_um\n").find("no measured part"), std::string::npos);
  EXPECT_NE(fault("part,time_min,deviation\n1,2,3\n").find("parts.csv:1: the column deviation"),
            std::string::npos);
  EXPECT_NE(fault("part,deviation_um\n1,3\n").find("transition, time_min or stamps"),
            std::string::npos);
  EXPECT_NE(fault("transition,time_min,deviation_um\n1,2,3\n").find("exactly one"),
            std::string::npos);
  EXPECT_NE(fault("time_min,time_s,deviation_um\n1,2,3\n").find("two columns"), std::string::npos);
  EXPECT_NE(fault("part,time_min\n1,2\n").find("deviation_um"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um\n1\n").find("1 fields"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um\n1,3,5\n").find("parts.csv:2"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um\n1,abc\n").find("not a finite"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um\n1,nan\n").find("not a finite"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um\n-1,2\n").find("is implausible"), std::string::npos);
  EXPECT_NE(fault("transition,deviation_um\n,2\n").find("is empty"), std::string::npos);
}

TEST(Measured, StampsCountFromTheStart) {
  MeasuredFormat format;
  format.started = table::stamp_of("2026-11-22T23:40+01:00");
  const std::string text = "part;gauged;deviation_um\n1;2026-11-22T23:50:30+01:00;4,5\n";
  const auto rows = parse_measured(text, "parts.csv", format);
  ASSERT_TRUE(rows) << kernel::outcome::text(rows.error());
  // 23:40 to 23:50:30.
  EXPECT_DOUBLE_EQ((*rows)[0].time_s, 630.0);
  EXPECT_DOUBLE_EQ((*rows)[0].deviation_mm, 0.0045);
  EXPECT_NE(fault(text).find("parts.csv:2: the parts have time stamps"), std::string::npos);
  const auto refused = [&](const std::string& stamp) {
    const auto other = parse_measured("gauged,deviation_um\n" + stamp + ",3\n", "p.csv", format);
    return other ? "" : kernel::outcome::text(other.error());
  };
  EXPECT_NE(refused("2026-11-22T23:50")
                .find("p.csv:2: \"2026-11-22T23:50\" is not a date and time "
                      "with a time zone"),
            std::string::npos);
  EXPECT_NE(refused("2026-11-22T23:39+01:00").find("before --started"), std::string::npos);
}

TEST(Measured, StampsBesideATransitionOnlySayWhenItWasGauged) {
  const auto rows =
      parse_measured("transition,gauged,deviation_um\n2,2026-11-22T23:50,4\n", "parts.csv");
  ASSERT_TRUE(rows) << kernel::outcome::text(rows.error());
  EXPECT_EQ((*rows)[0].transition, "2");
}

// 4.2 mm off is no thermal drift: these are µm in a column of mm.
TEST(Measured, RefusesAUnitThatMustBeWrong) {
  EXPECT_NE(fault("time_min,deviation_mm\n1,4.2\n").find("check the unit"), std::string::npos);
  EXPECT_NE(fault("time_min,deviation_um,tolerance_mm\n1,4.2,0\n").find("check the unit"),
            std::string::npos);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
