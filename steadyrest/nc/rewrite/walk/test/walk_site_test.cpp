// SPDX-License-Identifier: Apache-2.0
// The law of a safe place (README.md) for Z on linuxcnc, line by line.
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/walk/test/walk_shop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr std::size_t kAxisZ = 2;
const std::string kSafeStart = "G21 G90 G94 G17 G54 F100\nG0 X0 Y0 Z9\n";

/// The place before line `number` of a program.
Site site_before(std::uint32_t number, const std::string& program) {
  Site found = Site::none;
  test::WalkShop().walk(program, [&](const Walk& walk) {
    found = walk.line() == number ? walk.site('Z', kAxisZ) : found;
  });
  return found;
}
/// The same before the line behind a safe start and these lines.
Site site_after(const std::string& lines, const std::string& line) {
  const std::string before = kSafeStart + lines;
  const auto number = static_cast<std::uint32_t>(std::ranges::count(before, '\n') + 1);
  return site_before(number, before + line + "\nM2\n");
}

TEST(WalkSite, IsARapidAClearanceOrAFeed) {
  EXPECT_EQ(site_after("", "G0 Z5"), Site::rapid);
  EXPECT_EQ(site_after("", "N10 G0 X3 Z5 M8 (down)"), Site::rapid);
  EXPECT_EQ(site_after("", "G0 X5 Y5"), Site::clearance);
  EXPECT_EQ(site_after("", "G1 Z-1 F80"), Site::feed);
  EXPECT_EQ(site_after("", "G1 X5"), Site::none);
  EXPECT_EQ(site_after("", "M8"), Site::none) << "it makes no move";
  EXPECT_EQ(site_after("G1 X5\n", "G0 X9"), Site::none) << "no rapid before it";
  EXPECT_EQ(site_after("G4 P1\n", "G0 X9"), Site::none) << "a dwell is no rapid";
  EXPECT_EQ(site_after("G1 X5\n", "G0 Z5"), Site::rapid);
}

// Whatever might bend the path or send the axis elsewhere.
TEST(WalkSite, IsNoneWhereAShiftWouldNotBeSafe) {
  for (const char* line : {"G91 G0 Z5", "G53 G0 Z5", "G28 Z5", "G43 H1 G0 Z5", "G10 L2 P1 Z5",
                           "G92 Z5", "G55 G0 Z5", "G2 X1 Y1 Z5 I1", "G81 X1 Y1 Z-1 R2", "G4 P1",
                           "T1 M6 G0 Z5", "G95 G0 Z5", "G20 G0 Z5", "M0", "/G0 Z5"}) {
    EXPECT_EQ(site_after("", line), Site::none) << line;
  }
  for (const char* before : {"G91\n", "G93\n", "G2 X2 Y0 I1\n", "G41.1 D2\nG1 X5\n", "G7\n",
                             "G5 I0 J3 P0 Q-3 X2 Y2\n", "G38.2 Z-5\n", "o1 if [1]\n"}) {
    const std::string end = std::string(before).starts_with("o1") ? "\no1 endif" : "";
    EXPECT_EQ(site_after(before, "G0 Z5" + end), Site::none) << before;
  }
  EXPECT_EQ(site_after("G91\nG90\n", "G0 Z5"), Site::rapid);
  EXPECT_EQ(site_after("G41.1 D2\nG1 X5\nG40\n", "G0 Z5"), Site::rapid);
}

// From a tool change to its G43 a length is in force that is not the tool's.
TEST(WalkSite, IsNoneBetweenAToolAndItsLength) {
  EXPECT_EQ(site_after("T1 M6\n", "G0 Z5\nG43 H1"), Site::none);
  EXPECT_EQ(site_after("T1 M6\nG43 H1\n", "G0 Z5"), Site::rapid);
  EXPECT_EQ(site_after("T1 M6\n/G43 H1\n", "G0 Z5\nG43 H1"), Site::none) << "where it is skipped";
}

// A rapid that only restates the axis must know where the program sent it.
TEST(WalkSite, IsNoClearanceWhereTheAxisWasNotSentThere) {
  for (const char* before : {"G55\n", "G92 Z0\n", "G49\n", "G28\n", "G53 G0 Z0\n",
                             "G91 G0 Z1\nG90\n", "M61 Q2\n", "G52 Z1\n"}) {
    EXPECT_EQ(site_after(std::string(before) + "G0 X1\n", "G0 X5"), Site::none) << before;
    EXPECT_EQ(site_after(std::string(before) + "G0 X1\nG0 Z7\n", "G0 X5"), Site::clearance)
        << before;
  }
}

// In G91 or another work offset a shift would act nowhere, or elsewhere.
TEST(WalkSite, IsNoneBeforeTheProgramHasSaidItsModes) {
  EXPECT_EQ(site_before(2, "G21 G90 G54\nG0 Z5\nM2\n"), Site::rapid);
  EXPECT_EQ(site_before(2, "G21 G90\nG0 Z5\nM2\n"), Site::none);
  EXPECT_EQ(site_before(2, "G21 G54\nG0 Z5\nM2\n"), Site::none);
  EXPECT_EQ(site_before(3, "G54\n/G90\nG0 Z5\nM2\n"), Site::none);
  std::string_view unsaid;
  test::WalkShop().walk("G21 G90\nG0 Z5\nM2\n", [&](const Walk& walk) {
    const auto* const missing = walk.unsaid('Z', kAxisZ);
    unsaid = missing != nullptr ? missing->what : unsaid;
  });
  EXPECT_EQ(unsaid, "which work offset is active");
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
