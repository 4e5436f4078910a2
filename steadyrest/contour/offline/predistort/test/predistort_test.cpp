// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::contour::offline {
namespace {

class Desk {
 public:
  kernel::outcome::Result<Predistorted> run(const std::string& program,
                                            PredistortConfig how = {}) const {
    how.told = {{"changes", "predistort"}, {"tube-mm", fmt::format("{}", how.max_shift_mm)}};
    write(file(), program);
    nc::interpret::Config config;
    config.dialect = machine.control.dialect;
    config.axes = "XYZ";
    return predistort(file(), config, machine, how);
  }
  static void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  [[nodiscard]] std::string file() const { return folder_.at("part.ngc"); }

  kernel::machine::Machine machine = test::ideal_mill();

 private:
  kernel::file::testing::OwnFolder folder_;
};

/// The dwell lets the axes arrive before the cut.
const std::string kCircle =
    "G21 G90 G94 G17 G64\nG0 X10 Y-30 Z0\nG4 P0.5\nG1 Y0 F4000\nG3 X10 Y0 I-10 J0 P4\nG1 Y30\nG0 "
    "Z5\nM2\n";

// Truth: R′ = R·√(1 + q²) about the same centre, F′ = F·R′/R (contour README).
TEST(Predistort, WritesTheCircleThatTheClosedFormAsksFor) {
  const Desk desk;
  const auto done = desk.run(kCircle);
  ASSERT_TRUE(done.has_value());
  EXPECT_NEAR(done->before.nominal().max_mm, 0.0877, 2e-3);
  EXPECT_LT(done->after.nominal().max_mm, 0.004);
  EXPECT_LT(done->after.nominal().rms_mm(), 0.001);
  EXPECT_NEAR(done->seconds_after, done->seconds_before, 0.01 * done->seconds_before);
  const double q = 4000.0 / 60.0 / (10.0 * 50.0);
  const double radius = 10.0 * std::sqrt(1.0 + q * q);
  EXPECT_NEAR(done->largest_shift_mm, radius - 10.0, 0.005);
  const std::string feed = fmt::format(" F{:.0f}", 4000.0 * radius / 10.0).substr(0, 5);
  EXPECT_NE(done->replaced.text.find(feed), std::string::npos) << feed;
}

TEST(Predistort, KeepsTheOriginalInTheText) {
  const Desk desk;
  const auto done = desk.run(kCircle);
  ASSERT_TRUE(done.has_value());
  Desk::write(desk.file(), done->replaced.text);
  const auto back = nc::rewrite::put_back(desk.file());
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->text, kCircle);
}

TEST(Predistort, LeavesStraightLinesOfEqualAxesAlone) {
  const Desk desk;
  const auto done = desk.run("G21 G90 G94 G17 G64\nG0 X0 Y0\nG1 X80 Y60 F3000\nG0 Z5\nM2\n");
  ASSERT_TRUE(done.has_value());
  EXPECT_LT(done->after.nominal().max_mm, 1e-4);
  EXPECT_LT(done->largest_shift_mm, 1e-6);
}

// The rounding of a corner of 2° within 0.05 mm is 5.7 mm long: half of it is before the corner.
TEST(Predistort, ALongRoundingKeepsItsPlace) {
  Desk desk;
  desk.machine.axes[1].servo_gain_1_s = 55.0;
  const auto done = desk.run(
      "G21 G90 G94 G17 G64 P0.05\nG0 X0 Y0\nG4 P1\nG1 X40 Y40 F3000\nG1 X78.61 Y81.40\n"
      "G0 Z5\nM2\n",
      {.rounds = 0});
  ASSERT_TRUE(done.has_value());
  EXPECT_NEAR(done->before.nominal().max_mm, 25.0 * (1.0 / 50.0 - 1.0 / 55.0) + 0.05, 0.02);
}

TEST(Predistort, CorrectsUnequalAxesAsFarAsTheirGainsAreSure) {
  Desk desk;
  desk.machine.axes[1].servo_gain_1_s = 55.0;
  const std::string line = "G21 G90 G94 G17 G64\nG0 X0 Y0\nG1 X80 Y80 F3000\nG0 Z5\nM2\n";
  const auto sure = desk.run(line, {.gain_uncertainty = 0.0});
  const auto unsure = desk.run(line, {.gain_uncertainty = 0.08});
  ASSERT_TRUE(sure.has_value() && unsure.has_value());
  // (v/2)·sin 2θ·|1/kx − 1/ky|
  EXPECT_NEAR(sure->before.nominal().max_mm, 25.0 * (1.0 / 50.0 - 1.0 / 55.0), 2e-3);
  EXPECT_LT(sure->after.nominal().rms_mm(), 0.2 * sure->before.nominal().rms_mm());
  // 50 and 55 may be equal: then a correction would bend a straight line.
  EXPECT_NEAR(unsure->after.nominal().max_mm, unsure->before.nominal().max_mm, 1e-3);
}

TEST(Predistort, NeverLetsAnyModelWithinTheUncertaintyGetWorse) {
  Desk desk;
  for (const double other : {50.0, 52.0, 60.0}) {
    desk.machine.axes[1].servo_gain_1_s = other;
    const auto done = desk.run(kCircle + "", {.gain_uncertainty = 0.05});
    ASSERT_TRUE(done.has_value());
    EXPECT_LE(done->worst_after_mm, done->worst_before_mm + 5e-4) << other;
    for (std::size_t i = 0; i < done->before.others().size(); ++i) {
      EXPECT_LE(done->after.others()[i].rms_mm(), done->before.others()[i].rms_mm() + 5e-4) << i;
    }
  }
}

TEST(Predistort, LeavesBlocksThatItWouldHaveToShiftTooFar) {
  const Desk desk;
  const auto done = desk.run(kCircle, {.max_shift_mm = 0.05});
  ASSERT_TRUE(done.has_value());
  // The line before it meets the circle where the circle would have to be.
  EXPECT_EQ(done->too_far, (std::vector<std::uint32_t>{4, 5}));
  EXPECT_LE(done->largest_shift_mm, 0.05);
}

TEST(Predistort, WorksInIncrementsInchesAndATurnedOffset) {
  const Desk desk;
  const auto metric = desk.run(kCircle);
  ASSERT_TRUE(metric.has_value());
  const std::string incremental =
      "G20 G90 G94 G17 G64\nG10 L2 P1 R30 X1 Y2\nG54\nG0 X0.4 Y-1.2 Z0\nG4 P0.5\nG91\nG1 Y1.2 "
      "F157.48\nG3 "
      "X0 "
      "Y0 I-0.3937 J0 P4\nG1 Y1.2\nG90 G0 Z0.2\nG10 L2 P1 R0 X0 Y0\nM2\n";
  const auto other = desk.run(incremental);
  ASSERT_TRUE(other.has_value());
  EXPECT_NEAR(other->before.nominal().rms_mm(), metric->before.nominal().rms_mm(), 1e-3);
  EXPECT_LT(other->after.nominal().rms_mm(), 0.001);
  EXPECT_NE(other->replaced.text.find("G3 X"), std::string::npos);
}

TEST(Predistort, LeavesWhatTheControlDoesByItself) {
  const Desk desk;
  const auto done = desk.run(
      "G21 G90 G94 G17 G64\nG0 X0 Y0 Z5\nG81 X5 Y5 Z-2 R1 F500\nG80\nO100 sub\nG1 X20 "
      "F2000\nO100 endsub\nO100 call\nO100 call\nG0 X10 Y-30 Z0\nG4 P0.5\nG1 Y0 F4000\nG3 X10 Y0 "
      "I-10 J0 P2\nG0 "
      "Z5\nM2\n");
  ASSERT_TRUE(done.has_value());
  EXPECT_FALSE(done->lines.contains(3));
  EXPECT_LT(done->after.nominal().line_mm(13), 0.2 * done->before.nominal().line_mm(13));
}

// The control accepts no arc there, and that is no reason to refuse the whole program.
TEST(Predistort, LeavesTheFirstMoveAfterCompensationStraight) {
  Desk desk;
  desk.machine = test::ideal_mill(20.0);
  const auto done = desk.run(
      "G21 G90 G94 G17 G61\nF2000\nG0 X-9 Y-5\nG41.1 D0.01 G1 X-8 Y0\nG1 X0\nG40\n"
      "G1 X10 Y1\nG3 X10 Y21 R12\nG1 X0\nG0 Z5\nM2\n");
  ASSERT_TRUE(done.has_value()) << kernel::outcome::text(done.error());
  EXPECT_FALSE(done->lines.contains(7));
  EXPECT_TRUE(done->lines.contains(8));
  EXPECT_LT(done->after.nominal().rms_mm(), 0.85 * done->before.nominal().rms_mm());
}

// Of two arcs that become one the end is kept, before a stop too: else the proof refuses the last
// block, and the part keeps 42 µm RMS of 85.
TEST(Predistort, ACommandOfFewArcsEndsWhereTheProgramStops) {
  Desk desk;
  desk.machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  for (auto& axis : desk.machine.axes) {
    axis.servo_gain_1_s = 21.0;
    axis.velocity_lag_s = 0.005;
  }
  const std::string circle = "G2 X9 Y0 I-9 J0\n";
  const auto done = desk.run("G21 G90 G17 G94 G61\nG0 X9 Y0 Z0\nG4 P0.5\nG1 F1800\n" + circle +
                                 circle + circle + circle + "G4 P0.5\nM2\n",
                             {.max_shift_mm = 2.0, .gain_uncertainty = 0.002});
  ASSERT_TRUE(done.has_value());
  EXPECT_TRUE(done->unproved.empty());
  EXPECT_EQ(done->replaced.replaced, 4U);
  EXPECT_LT(done->after.nominal().rms_mm(), 0.05 * done->before.nominal().rms_mm());
}

// A line of equal axes needs nothing, whatever its F looks like.
TEST(Predistort, LeavesBlocksThatItWouldNotChange) {
  const Desk desk;
  const std::string lines = "G21 G90 G94 G17 G61\nG0 X0 Y0\nG1 X80 Y60 F1000\nX160 Y120\n";
  const auto alone = desk.run(lines + "G0 Z5\nM2\n", {.limit_mm = 1e-9});
  ASSERT_TRUE(alone.has_value());
  EXPECT_EQ(alone->replaced.replaced, 0U);
  EXPECT_EQ(alone->largest_shift_mm, 0.0);
  EXPECT_EQ(alone->replaced.text, lines + "G0 Z5\nM2\n");
}

TEST(Predistort, NamesTheShiftOfWhatItHasChanged) {
  const Desk desk;
  const auto done = desk.run(kCircle, {.max_shift_mm = 0.05});
  ASSERT_TRUE(done.has_value());
  EXPECT_FALSE(done->too_far.empty());
  EXPECT_LT(done->largest_shift_mm, 0.049);
}

// A linear program over the command finds 2.1 µm at full speed (|c̈| ≤ 2000 mm/s² per axis), where
// the alternating arcs of a close fit leave 108 µm in 20 blocks.
TEST(Predistort, LeadsAFilletByAFewArcsAtFullSpeed) {
  Desk desk;
  desk.machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  const auto done = desk.run(
      "G21 G90 G17 G94 G61\nG0 X-20 Y0 Z0\nG4 P0.5\nG1 X0 Y0 F2400\nG3 X2 Y2 I0 J2\n"
      "G1 X2 Y20\nG4 P0.5\nM2\n",
      {.max_shift_mm = 2.0});
  ASSERT_TRUE(done.has_value());
  EXPECT_GT(done->before.nominal().max_mm, 0.5);
  EXPECT_LT(done->after.nominal().max_mm, 0.030);
  EXPECT_LE(done->replaced.new_lines, 10U);
  EXPECT_LT(done->seconds_after, 1.02 * done->seconds_before);
}

// Lower feeds alone take 1.42 times the time of the fillet and twice that of the half circles. A
// linear program over the commands leaves 12.5 µm on the fillet at full speed.
TEST(Predistort, HoldsALimitByThePathInNearlyTheProgramsTime) {
  Desk desk;
  desk.machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  const std::string head = "G21 G90 G17 G94 G61\n";
  const std::string tail = "G4 P0.5\nM2\n";
  for (const char* const cut :
       {"G0 X-20 Y0 Z0\nG4 P0.5\nG1 X0 Y0 F3000\nG3 X2 Y2 I0 J2\nG1 X2 Y20\n",
        "G0 X3 Y0 Z0\nG4 P0.5\nG1 F2400\nG3 X-3.8 Y0 I-3.4 J0\nG3 X4.6 Y0 I4.2 J0\n"
        "G3 X-5.4 Y0 I-5 J0\nG3 X6.2 Y0 I5.8 J0\n"}) {
    const auto done = desk.run(head + cut + tail, {.max_shift_mm = 2.0, .hold_mm = 0.010});
    ASSERT_TRUE(done.has_value()) << cut;
    EXPECT_GT(done->before.nominal().max_mm, 0.15) << cut;
    EXPECT_LE(done->after.nominal().max_mm, 0.0105) << cut;
    EXPECT_LT(done->seconds_after, 1.05 * done->seconds_before) << cut;
  }
}

// Truth: the same path with one block in place of two in line, which LinuxCNC makes one.
TEST(Predistort, PredictsBlocksThatTheControlMerges) {
  Desk desk;
  desk.machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  const std::string head = "G21 G90 G17 G94 G64 P0.02\nG0 X0 Y0 Z0\nG4 P0.3\nF2400\n";
  const std::string tail = "G1 X30 Y0\nG1 X33 Y5\nG1 X15 Y10\nG4 P0.3\nG0 Z8\nM2\n";
  const auto one = desk.run(head + tail, {.rounds = 0});
  const auto two = desk.run(head + "G1 X17 Y0\n" + tail, {.rounds = 0});
  ASSERT_TRUE(one.has_value() && two.has_value());
  EXPECT_LT(one->before.nominal().max_mm, 1.0);
  EXPECT_NEAR(two->before.nominal().max_mm, one->before.nominal().max_mm, 1e-6);
  EXPECT_NEAR(two->before.nominal().rms_mm(), one->before.nominal().rms_mm(), 1e-6);
}

// Out and back on the line, where the control stops anyway: the tool stands when the next cut
// begins. Without it the axes come to the floor while they cut.
TEST(Predistort, LeadsAPlungeBeyondAndBack) {
  Desk desk;
  desk.machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  const auto done = desk.run(
      "G21 G90 G17 G94 G61\nG0 X0 Y0 Z8\nG4 P0.5\nG1 Z0 F600\nG1 X60 F2400\nG4 P0.5\nG0 Z8\n"
      "M2\n",
      {.max_shift_mm = 2.0, .most_time = 1.1});
  ASSERT_TRUE(done.has_value());
  EXPECT_GT(done->before.nominal().max_mm, 0.15);
  EXPECT_LT(done->after.nominal().max_mm, 0.01);
  // 2·ln 2/k and ramps
  EXPECT_LT(done->seconds_after, done->seconds_before + 0.1);
}

TEST(Predistort, TellsItsPhases) {
  const Desk desk;
  std::vector<std::string> phases;
  double last = 0.0;
  const auto done = desk.run(kCircle, {.progress = [&](double share, std::string_view what) {
                               EXPECT_GE(share, last);
                               last = share;
                               if (phases.empty() || phases.back() != what) {
                                 phases.emplace_back(what);
                               }
                             }});
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(phases,
            (std::vector<std::string>{"predicting the error", "shaping the path", "leading corners",
                                      "refining the path", "polishing the path"}));
  EXPECT_LT(last, 1.0);
}

TEST(Predistort, RefusesWhatCutsNothing) {
  const Desk desk;
  const auto done = desk.run("G21 G90\nG0 X5\nM2\n");
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().what, "the program cuts nothing");
}

}  // namespace
}  // namespace steadyrest::contour::offline
