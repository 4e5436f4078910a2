// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "expectations.hpp"
#include "linuxcnc/linuxcnc_files.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/machine/unlimited.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::test {
namespace {

using kernel::machine::Axis;
using testing::HasSubstr;

constexpr double kTurn = std::numbers::pi / 180.0;

/// The machine file of an INI text, read back.
kernel::machine::Machine machine_of(const Scratch& scratch, const std::string& ini) {
  const std::string output = scratch.at("machine.toml");
  const Finished made = run({"machine", "from-linuxcnc", scratch.file("m.ini", ini), "-o", output});
  EXPECT_EQ(made.code, 0) << made.err;
  auto machine = passport::read(output);
  EXPECT_TRUE(machine) << (machine ? "" : machine.error().what);
  return machine ? *machine : kernel::machine::Machine{};
}

void expect_axis(const Axis& axis, const char* name, double speed, double acceleration, double min,
                 double max) {
  EXPECT_EQ(axis.name, name);
  EXPECT_TRUE(axis.present) << name;
  EXPECT_NEAR(axis.max_speed_au_s, speed, 1e-9 * speed) << name;
  EXPECT_NEAR(axis.max_acceleration_au_s2, acceleration, 1e-9 * acceleration) << name;
  EXPECT_NEAR(axis.min_au, min, 1e-9 * std::abs(min)) << name;
  EXPECT_NEAR(axis.max_au, max, 1e-9 * std::abs(max)) << name;
}

// Inches become mm, travel is what axis and joints leave, the lathe has no Y.
TEST(FromLinuxCnc, ConvertsEveryFigure) {
  const Scratch scratch;
  const auto machine = machine_of(scratch, inch_lathe());
  EXPECT_EQ(machine.name, "Lathe \"9\\\"");
  EXPECT_EQ(machine.port, kernel::machine::PortKind::linuxcnc);
  EXPECT_EQ(machine.mode, kernel::machine::Mode::observe);
  EXPECT_EQ(machine.control.dialect, kernel::machine::Dialect::linuxcnc);
  EXPECT_EQ(machine.control.units, kernel::machine::ProgramUnit::inch);
  EXPECT_DOUBLE_EQ(machine.control.servo_period_s, 0.0005);
  EXPECT_DOUBLE_EQ(machine.control.interpolator_period_s, 0.0005);
  EXPECT_DOUBLE_EQ(machine.control.max_feed_mm_s, 101.6);
  EXPECT_EQ(machine.control.max_path_acceleration_mm_s2, kernel::machine::kUnlimited);
  EXPECT_EQ(machine.control.look_ahead_blocks, 160U);
  EXPECT_DOUBLE_EQ(machine.control.blend_gap_cycles, 7.0);
  EXPECT_DOUBLE_EQ(machine.control.junction_share, 0.1);
  ASSERT_EQ(machine.axes.size(), 4U);
  expect_axis(machine.axes[0], "X", 50.8, 508.0, -50.8, 76.2);
  EXPECT_FALSE(machine.axes[1].present);
  expect_axis(machine.axes[2], "Z", 76.2, 762.0, -228.6, 12.7);
  expect_axis(machine.axes[3], "C", 90.0 * kTurn, 360.0 * kTurn, -1e6, 1e6);
  EXPECT_NEAR(machine.spindle.max_rev_s, 50.0, 1e-12);
  EXPECT_NEAR(machine.spindle.min_rev_s, 1.0, 1e-12);
  // Adaptive feed only lowers, whatever the panel may.
  EXPECT_DOUBLE_EQ(machine.feed_override.ratio.back(), 1.0);
  EXPECT_DOUBLE_EQ(machine.feed_override.max_ratio, 1.0);
  EXPECT_THAT(machine.spindle_override.ratio,
              testing::Pointwise(testing::DoubleNear(1e-12),
                                 {0.72, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.12}));
  const std::string text = text_of_file(scratch.at("machine.toml"));
  EXPECT_THAT(text, HasSubstr("# [JOINT_1] MAX_VELOCITY = 1 is lower"));
  EXPECT_THAT(text, HasSubstr("# max_path_acceleration_mm_s2: no [TRAJ] MAX_LINEAR_ACCELERATION"));
}

TEST(FromLinuxCnc, SaysWhatIsAssumed) {
  const auto answer = answer_of("machine from-linuxcnc examples/linuxcnc/mill.ini -o machine.toml");
  EXPECT_EQ(answer["from_ini"], 25);
  ASSERT_EQ(answer["assumed"].size(), 12U);
  EXPECT_THAT(answer["assumed"][1].get<std::string>(),
              HasSubstr("axis X: servo_gain_1_s = 20 (`steadyrest machine from-log`"));
  EXPECT_THAT(answer["written"][0]["file"].get<std::string>(), "machine.toml");
}

// The shipped machine file of the same control: what it has from the INI is found there.
TEST(FromLinuxCnc, FindsThePlannerOfTheExampleMill) {
  const Scratch scratch;
  const auto made = machine_of(scratch, text_of_file(project_file("examples/linuxcnc/mill.ini")));
  const auto mill = passport::read(project_file("examples/machines/linuxcnc-mill.toml"));
  ASSERT_TRUE(mill);
  const auto& a = made.control;
  const auto& b = mill->control;
  EXPECT_EQ(a.look_ahead_blocks, b.look_ahead_blocks);
  EXPECT_EQ(a.corner_tolerance_mm, b.corner_tolerance_mm);
  EXPECT_EQ(a.junction_deviation_mm, b.junction_deviation_mm);
  EXPECT_EQ(a.junction_share, b.junction_share);
  EXPECT_EQ(a.centripetal_share, b.centripetal_share);
  EXPECT_EQ(a.blend_share, b.blend_share);
  EXPECT_EQ(a.blend_gap_cycles, b.blend_gap_cycles);
  EXPECT_EQ(a.min_block_cycles, b.min_block_cycles);
  EXPECT_EQ(a.merge_share, b.merge_share);
  EXPECT_EQ(a.corner_acceleration_share, b.corner_acceleration_share);
  EXPECT_EQ(a.stop_between_rapid_and_feed, b.stop_between_rapid_and_feed);
  EXPECT_EQ(a.clips_programmed_feed, b.clips_programmed_feed);
  EXPECT_EQ(a.rapid_mm_s, a.max_feed_mm_s);
}

/// A three-axis mill in mm; each part may add lines to a section.
std::string small_mill(const std::string& interpreter, const std::string& io = "",
                       const std::string& axis_a = "", const std::string& units = "mm",
                       const std::string& joint = "", const std::string& hal = "none.hal") {
  const std::string limits = "MAX_VELOCITY = 40\nMAX_ACCELERATION = 500\n";
  std::string ini = "[EMCIO]\n" + io +
                    "[KINS]\nJOINTS = 4\nKINEMATICS = trivkins coordinates=XYZA\n" +
                    "[TRAJ]\nCOORDINATES = XYZA\nLINEAR_UNITS = " + units +
                    "\nANGULAR_UNITS = degree\n[EMCMOT]\nSERVO_PERIOD = 1000000\n[RS274NGC]\n" +
                    interpreter + "[HAL]\nHALFILE = " + hal + "\n[AXIS_A]\n" + limits + axis_a;
  for (const char* section : {"AXIS_X", "AXIS_Y", "AXIS_Z", "JOINT_1", "JOINT_2"}) {
    ini += std::string("[") + section + "]\n" + limits;
  }
  return ini + "[JOINT_3]\nTYPE = ANGULAR\n[JOINT_0]\n" + joint;
}

// LinuxCNC 2.10, by its documentation and source: 2.9 does not know these keys.
TEST(FromLinuxCnc, CarriesThePlannerWithLimitedJerk) {
  const Scratch scratch;
  const auto with = [&](const std::string& keys) {
    std::string ini = small_mill("");
    ini.insert(ini.find("COORDINATES"), keys);
    return machine_of(scratch, ini).control;
  };
  using kernel::machine::LinuxCncPlanner;
  const auto s_curve = with("PLANNER_TYPE = 1\nMAX_LINEAR_JERK = 20000\n");
  EXPECT_EQ(s_curve.planner, LinuxCncPlanner::s_curve);
  EXPECT_EQ(s_curve.max_path_jerk_mm_s3, 20000.0);
  EXPECT_EQ(with("MAX_LINEAR_JERK = 20000\n").planner, LinuxCncPlanner::trapezoid);
  // Below 1 LinuxCNC warns and takes the other.
  EXPECT_EQ(with("PLANNER_TYPE = 1\nMAX_LINEAR_JERK = 0.5\n").planner, LinuxCncPlanner::trapezoid);
}

std::string list_of(const nlohmann::json& list) {
  return list.dump();
}

// What the INI file tells the interpreter acts on every program that is read with the machine file.
TEST(FromLinuxCnc, ProgramsAreReadAsTheIniFileTellsTheInterpreter) {
  const Scratch scratch;
  const std::string machine = scratch.at("m.toml");
  const auto said = [&](const std::string& ini, const std::string& program) {
    EXPECT_EQ(run({"machine", "from-linuxcnc", scratch.file("m.ini", ini), "-o", machine}).code, 0);
    const Finished got =
        run({"program", "moves", scratch.file("p.ngc", program), "--machine", machine});
    return got.code == 0 ? got.out : got.err;
  };
  // A column of the last move.
  const auto last = [&](const std::string& ini, const std::string& program, std::size_t column) {
    const std::string text = said(ini, program);
    std::istringstream line(text.substr(text.rfind('\n', text.size() - 2) + 1));
    std::string cell;
    for (std::size_t i = 0; i <= column; ++i) {
      std::getline(line, cell, ',');
    }
    return std::stod(cell);
  };
  constexpr std::size_t kX = 2;
  constexpr std::size_t kZ = 4;
  constexpr std::size_t kA = 5;
  EXPECT_NEAR(last(small_mill("RS274NGC_STARTUP_CODE = G20 G64 P0.001\n", "", "", "inch"),
                   "G0 X3\nM2\n", kX),
              76.2, 1e-9);
  EXPECT_EQ(last(small_mill("", "TOOL_CHANGE_QUILL_UP = 1\n"), "G21 G0 Z-20\nM6\nM2\n", kZ), 0.0);
  EXPECT_EQ(last(small_mill("", "", "WRAPPED_ROTARY = 1\n"), "G21 G0 A350\nG0 A10\nM2\n", kA),
            370.0);
  EXPECT_THAT(said(small_mill("REMAP = M6 modalgroup=6 ngc=change\nREMAP=G88.8 py=x\n"),
                   "G21 G0 X1\nM6\nM2\n"),
              HasSubstr("M6 is remapped on this machine"));
  const std::string text = text_of_file(machine);
  EXPECT_THAT(text, HasSubstr("remapped = \"M6 G88.8\""));
}

TEST(FromLinuxCnc, NamesWhatItDoesNotCarryAndWhereEachValueIsFrom) {
  const Scratch scratch;
  const std::string ini = scratch.file(
      "m.ini", small_mill("PARAMETER_FILE = l.var\nUSER_M_PATH = m\nODD = 1\n",
                          "RANDOM_TOOLCHANGER = 1\nTOOL_CHANGE_POSITION = 1 2 3\n", "", "inch"));
  const Finished made =
      run({"machine", "from-linuxcnc", ini, "-o", scratch.at("m.toml"), "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const auto answer = nlohmann::json::parse(made.out);
  const std::string lost = list_of(answer["not_carried"]);
  for (const char* name :
       {"PARAMETER_FILE", "USER_M_PATH", "ODD", "RANDOM_TOOLCHANGER", "none.hal"}) {
    EXPECT_THAT(lost, HasSubstr(name));
  }
  const std::string values = list_of(answer["values"]);
  EXPECT_THAT(values, HasSubstr("\"key\":\"program.tool_change_position_mm\",\"value\":\"[25.4, "
                                "50.8, 76.2]\""));
  EXPECT_THAT(values, HasSubstr(ini + ":3: [EMCIO] TOOL_CHANGE_POSITION = 1 2 3"));
}

// What LinuxCNC takes and a machine file does not is cut to the largest allowed, and named.
TEST(FromLinuxCnc, CutsValuesBeyondItsRangeAndSaysSo) {
  const Scratch scratch;
  const std::string ini =
      scratch.file("m.ini", "[DISPLAY]\nMAX_FEED_OVERRIDE = 15\nMAX_SPINDLE_OVERRIDE = 20\n" +
                                small_mill("", "", "MAX_LIMIT = 1e99\n") + "[SPINDLE_0]\n" +
                                "MAX_FORWARD_VELOCITY = 1e9\n");
  const Finished made =
      run({"machine", "from-linuxcnc", ini, "-o", scratch.at("m.toml"), "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string clipped = list_of(nlohmann::json::parse(made.out)["clipped"]);
  EXPECT_THAT(clipped, HasSubstr(":2: [DISPLAY] MAX_FEED_OVERRIDE = 15 is 1500 %: 1000 is taken"));
  EXPECT_THAT(clipped, HasSubstr("MAX_SPINDLE_OVERRIDE = 20 is 2000 %"));
  EXPECT_THAT(clipped, HasSubstr("MAX_FORWARD_VELOCITY = 1e9"));
}

// A loop whose output is a velocity has its gain in 1/s.
TEST(FromLinuxCnc, TakesTheServoDataOfIniAndHal) {
  const Scratch scratch;
  const std::string hal =
      "loadrt pid names=pid.x\nsetp pid.x.Pgain [JOINT_0]P\nsetp pid.x.FF1 [JOINT_0]FF1\n"
      "setp hm2.0.stepgen.00.position-scale [JOINT_0]STEP_SCALE\n"
      "net x-cmd joint.0.motor-pos-cmd => pid.x.command\n"
      "net x-out pid.x.output => hm2.0.stepgen.00.velocity-cmd\n"
      "net x-fb hm2.0.stepgen.00.position-fb => pid.x.feedback joint.0.motor-pos-fb\n";
  scratch.file("x.hal", hal);
  const auto machine = machine_of(
      scratch, small_mill("", "", "", "mm", "P = 50\nFF1 = 0.95\nSTEP_SCALE = -800\n", "x.hal"));
  ASSERT_FALSE(machine.axes.empty());
  EXPECT_DOUBLE_EQ(machine.axes[0].servo_gain_1_s, 50.0);
  EXPECT_DOUBLE_EQ(machine.axes[0].feed_forward, 0.95);
  EXPECT_DOUBLE_EQ(machine.axes[0].encoder.count_au, 0.00125);
  EXPECT_THAT(text_of_file(scratch.at("machine.toml")), HasSubstr("x.hal:2: setp pid.x.Pgain 50"));
  // An output in volts tells no gain: it stays ASSUMED, and the entry is named.
  std::string volts = hal;
  volts.replace(volts.find("velocity-cmd"), 12, "value-of-dac");
  scratch.file("x.hal", volts);
  const auto open = machine_of(
      scratch, small_mill("", "", "", "mm", "P = 50\nFF1 = 0.1\nSTEP_SCALE = 800\n", "x.hal"));
  EXPECT_DOUBLE_EQ(open.axes[0].servo_gain_1_s, 20.0);
  EXPECT_THAT(text_of_file(scratch.at("machine.toml")),
              HasSubstr("only if its output is a velocity"));
  // A simulator that feeds the command back has no encoder for the scale.
  scratch.file("x.hal", "net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb\n");
  const auto simulator =
      machine_of(scratch, small_mill("", "", "", "mm", "INPUT_SCALE = 157.48\n", "x.hal"));
  EXPECT_LT(simulator.axes[0].encoder.count_au, 0.002)
      << "no encoder of this machine counts 1/157.48 mm";
  EXPECT_THAT(text_of_file(scratch.at("machine.toml")), HasSubstr("have no encoder for it"));
}

struct Fault {
  const char* was;
  const char* becomes;
  const char* line;  ///< of the refusal; empty: the file as a whole
  const char* what;
};

TEST(FromLinuxCnc, RefusesByLineAndName) {
  const Scratch scratch;
  for (const Fault& fault : {
           Fault{"JOINTS = 4\n", "", "8", "there is no [KINS] JOINTS"},
           Fault{"JOINTS = 4", "JOINTS = many", "10", "JOINTS = many is not a number"},
           Fault{"JOINTS = 4", "JOINTS = 2", "12", "have no C"},
           Fault{"JOINTS = 4", "JOINTS = 2.5", "10", "whole numbers 1 … 16"},
           Fault{"trivkins coordinates=xzzc", "genhexkins", "9", "allowed: trivkins"},
           Fault{"coordinates=xzzc", "coordinates=xq", "9", "allowed letters"},
           Fault{"COORDINATES = X Z C", "COORDINATES = X", "12",
                 "COORDINATES = X: one axis; allowed: 2 or more"},
           Fault{"LINEAR_UNITS = inch", "LINEAR_UNITS = ell", "13", "is not a unit"},
           Fault{"LINEAR_UNITS = inch\n", "", "11", "there is no [TRAJ] LINEAR_UNITS"},
           Fault{"SERVO_PERIOD = 500000", "SERVO_PERIOD = 5", "19", "allowed: 50000"},
           Fault{"[AXIS_Z]", "[AXIS_Y]", "", "there is no section [AXIS_Z]"},
           Fault{"[JOINT_2]", "[JOINT_9]", "", "there is no section [JOINT_2]"},
           Fault{"MAX_LIMIT = 0.5", "MAX_LIMIT = -9.5", "44",
                 "[JOINT_2] MAX_LIMIT = -9.5 is not above [JOINT_1] MIN_LIMIT = -9"},
           Fault{"MAX_VELOCITY = 3", "MAX_VELOCITY = 0", "33", "is 0 mm/s; allowed:"},
           Fault{"MAX_ACCELERATION = 360", "MAX_ACCELERATION = -1", "37", "allowed: 0.1 …"},
           Fault{"TYPE = LINEAR", "TYPE = ANGULAR", "39", "for the axis X, which is linear"},
       }) {
    std::string ini = inch_lathe();
    ini.replace(ini.find(fault.was), std::string(fault.was).size(), fault.becomes);
    const std::string file = scratch.file("m.ini", ini);
    const Finished made = run({"machine", "from-linuxcnc", file, "-o", scratch.at("none.toml")});
    EXPECT_EQ(made.code, 2) << fault.becomes;
    const std::string line = fault.line[0] == '\0' ? "" : std::string(":") + fault.line;
    EXPECT_THAT(made.err, testing::StartsWith("steadyrest: " + file + line + ": "));
    EXPECT_THAT(made.err, HasSubstr(fault.what));
    EXPECT_FALSE(std::filesystem::exists(scratch.at("none.toml"))) << fault.becomes;
  }
}

TEST(FromLinuxCnc, RefusesWhatIsNoIniFile) {
  const Scratch scratch;
  expect_refused("machine from-linuxcnc examples/programs/rib-pocket.ngc -o m.toml",
                 "rib-pocket.ngc:1: is not an INI file");
  expect_refused("machine from-linuxcnc examples/records/circle-start.sqlite -o m.toml", "binary");
  expect_refused("machine from-linuxcnc examples -o m.toml", "is a folder");
  expect_refused("machine from-linuxcnc none.ini -o m.toml", "cannot be read");
}

// An included file is an input, which no output replaces.
TEST(FromLinuxCnc, ReplacesNoIncludedFile) {
  const Scratch scratch;
  const std::string inc = scratch.file("traj.inc", "[[axis]]\n");
  const std::string ini = scratch.file("m.ini", "#INCLUDE traj.inc\n" + inch_lathe());
  EXPECT_EQ(run({"machine", "from-linuxcnc", ini, "-o", inc}).code, 2);
  EXPECT_EQ(text_of_file(inc), "[[axis]]\n");
}

}  // namespace
}  // namespace steadyrest::test
