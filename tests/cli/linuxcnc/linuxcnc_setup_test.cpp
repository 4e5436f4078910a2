// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "linuxcnc/linuxcnc_files.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Texts = FolderTexts;

/// A folder with a configuration, and the verb on it.
class LinuxCncSetup : public testing::Test {
 protected:
  LinuxCncSetup() {
    scratch_.file("m.ini", inch_lathe());
    scratch_.file("m.hal", crowded_hal());
  }
  [[nodiscard]] std::string ini() const { return scratch_.at("m.ini"); }
  Finished setup(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"linuxcnc", "setup", ini()});
    return run(more);
  }
  void expect_setup_refused(const std::string& where, const std::string& what,
                            const std::vector<std::string>& more = {}) {
    const Texts before = texts_in(scratch_.path());
    const Finished finished = setup(more);
    EXPECT_EQ(finished.code, 2) << what;
    EXPECT_THAT(finished.err, HasSubstr(where));
    EXPECT_THAT(finished.err, HasSubstr(what));
    EXPECT_EQ(texts_in(scratch_.path()), before) << what;
  }
  void replace(const std::string& name, const std::string& was, const std::string& becomes) {
    std::string text = text_of_file(scratch_.at(name));
    ASSERT_NE(text.find(was), std::string::npos) << was;
    scratch_.file(name, text.replace(text.find(was), was.size(), becomes));
  }
  Scratch scratch_;
};

TEST_F(LinuxCncSetup, FitsInWithWhatTheMachineHas) {
  const Finished finished = setup({"--json"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  const json answer = json::parse(finished.out);
  ASSERT_EQ(answer["files"].size(), 3U);
  EXPECT_EQ(answer["files"][0]["file"], ini());
  EXPECT_EQ(answer["files"][0]["change"], "changed");
  EXPECT_EQ(answer["files"][1]["file"], scratch_.at("m.hal"));
  EXPECT_EQ(answer["files"][2]["file"], scratch_.at("m-layer.hal"));
  EXPECT_EQ(answer["files"][2]["change"], "created");
  const std::string ini_text = text_of_file(ini());
  EXPECT_THAT(ini_text, HasSubstr("HALFILE = m.hal\n# steadyrest begin "));
  EXPECT_THAT(ini_text, HasSubstr("HALUI = halui\nHALFILE = m-layer.hal\n# steadyrest end\n"));
  EXPECT_THAT(ini_text, Not(HasSubstr("OFFSET_AV_RATIO")));
  const std::string own = text_of_file(scratch_.at("m.hal"));
  EXPECT_THAT(own, HasSubstr("# was: loadrt mux2\nloadrt mux2 count=5\n"));
  EXPECT_THAT(
      own,
      HasSubstr("# was: loadrt \\\n# was:   limit2 names=soft\n"
                "loadrt limit2 names=soft,layer.feed-ramp,layer.feed-most,layer.spindle-ramp\n"));
  EXPECT_THAT(own, HasSubstr("loadrt mult2 count=4\n"));
  const std::string layer = text_of_file(scratch_.at("m-layer.hal"));
  EXPECT_THAT(layer, HasSubstr("net layer-feed => mux2.2.in1\n"));
  EXPECT_THAT(layer, HasSubstr("net path-speed motion.current-vel => sampler.0.pin.3\n"));
  EXPECT_THAT(layer, HasSubstr("net spindle-seen => sampler.0.pin.7\n"));
  EXPECT_THAT(layer, HasSubstr("net spindle-cmd spindle.0.speed-out => mult2.3.in0\n"));
  EXPECT_THAT(layer, HasSubstr("net layer-z-command joint.1.pos-cmd => sampler.1.pin.9\n"));
  EXPECT_THAT(layer, HasSubstr("net layer-c-lag joint.3.f-error => sampler.1.pin.15\n"));
  for (const char* component : {"mux2", "limit2", "mult2"}) {
    EXPECT_THAT(layer, Not(HasSubstr(std::string("loadrt ") + component)));
  }
}

TEST_F(LinuxCncSetup, SaysWhichSpindleSpeedIsNotScaled) {
  const json answer = json::parse(setup({"--json", "--dry-run"}).out);
  std::string notes;
  for (const json& note : answer["notes"]) {
    notes += note["file"].get<std::string>() + ":" + std::to_string(note["line"].get<int>()) +
             ": " + note["what"].get<std::string>() + "; " + note["to_do"].get<std::string>() +
             "\n";
  }
  EXPECT_THAT(notes, HasSubstr("m.hal:8: spindle-cmd takes spindle.0.speed-out to pwm.value: not "
                               "scaled by the layer; net layer-drive-rpm to the drive's pin"));
  EXPECT_THAT(notes, HasSubstr("M52 P1"));
  EXPECT_THAT(notes, HasSubstr("Z has 2 joints; the layer reads joint 1"));
}

TEST_F(LinuxCncSetup, ConnectsOffsetsWhenAsked) {
  replace("m.ini", "[AXIS_Z]\n", "[AXIS_Z]\nOFFSET_AV_RATIO = 0.05\n");
  ASSERT_EQ(setup({"--offsets", "--offset-share", "0.3"}).code, 0);
  const std::string ini_text = text_of_file(ini());
  EXPECT_THAT(ini_text, testing::ContainsRegex("\\[AXIS_X\\]\n# steadyrest begin .*\n"
                                               "OFFSET_AV_RATIO = 0.3\n# steadyrest end\n"));
  EXPECT_THAT(ini_text, HasSubstr("[AXIS_Z]\nOFFSET_AV_RATIO = 0.05\nMIN_LIMIT"));
  EXPECT_THAT(ini_text, HasSubstr("[AXIS_C]\nMAX_VELOCITY"));
  const std::string layer = text_of_file(scratch_.at("m-layer.hal"));
  EXPECT_THAT(layer, HasSubstr("sets layer-unit-mm 25.4\n"));
  // Counts of half a millionth of an inch; 5 mm/s in inches.
  EXPECT_THAT(layer, HasSubstr("setp axis.x.eoffset-scale 0.0000005\n"));
  EXPECT_THAT(layer, HasSubstr("setp layer.offset-x.gain0 2000000\n"));
  EXPECT_THAT(layer, HasSubstr("setp layer.path-ramp-x.maxv 0.1968503937\n"));
  EXPECT_THAT(layer, HasSubstr("net layer-offset-2 => layer.offset-z.in0\n"));
  EXPECT_THAT(layer, HasSubstr("newsig layer-offset-1 float\n"));
}

TEST_F(LinuxCncSetup, UndoesByteForByte) {
  const Texts before = texts_in(scratch_.path());
  ASSERT_EQ(setup({"--offsets"}).code, 0);
  EXPECT_NE(texts_in(scratch_.path()), before);
  const Finished undone = setup({"--undo", "--json"});
  ASSERT_EQ(undone.code, 0) << undone.err;
  EXPECT_EQ(texts_in(scratch_.path()), before);
  EXPECT_EQ(json::parse(undone.out)["files"].size(), 3U);
  expect_setup_refused(ini(), "is not set up", {"--undo"});
}

TEST_F(LinuxCncSetup, UndoKeepsEditsElsewhere) {
  ASSERT_EQ(setup().code, 0);
  replace("m.ini", "MAX_VELOCITY = 2\n", "MAX_VELOCITY = 2.5\n");
  scratch_.file("m.hal", text_of_file(scratch_.at("m.hal")) + "net more a.b c.d\n");
  ASSERT_EQ(setup({"--undo"}).code, 0);
  std::string ini_text = inch_lathe();
  ini_text.replace(ini_text.find("MAX_VELOCITY = 2\n"), 17, "MAX_VELOCITY = 2.5\n");
  EXPECT_EQ(texts_in(scratch_.path()),
            (Texts{{"m.ini", ini_text}, {"m.hal", crowded_hal() + "net more a.b c.d\n"}}));
}

TEST_F(LinuxCncSetup, UndoIsRefusedWhereItCannotBeExact) {
  ASSERT_EQ(setup().code, 0);
  const Texts done = texts_in(scratch_.path());
  const auto again = [&] {
    for (const auto& [name, text] : done) {
      scratch_.file(name, text);
    }
  };
  replace("m.ini", "HALFILE = m-layer.hal", "HALFILE = ./m-layer.hal");
  expect_setup_refused("m.ini:22", "was edited since setup", {"--undo"});
  again();
  replace("m.hal", "loadrt mux2 count=5", "loadrt mux2 count=7");
  expect_setup_refused("m.hal:3", "was edited since setup", {"--undo"});
  again();
  replace("m-layer.hal", "0.020", "0.050");
  expect_setup_refused("m-layer.hal:1", "was edited since setup", {"--undo"});
  again();
  replace("m.ini", "HALFILE = m.hal\n", "HALFILE = m.hal\nHALFILE = m-layer.hal\n");
  expect_setup_refused("m.ini:22", "is outside the block", {"--undo"});
  again();
  EXPECT_EQ(setup({"--undo"}).code, 0);
}

TEST_F(LinuxCncSetup, RunsOnce) {
  ASSERT_EQ(setup().code, 0);
  expect_setup_refused("m.ini:22", "is set up already");
}

// The other configuration of the folder loads the layer's file, too: it stays.
TEST_F(LinuxCncSetup, KeepsAFileThatAnotherConfigurationLoads) {
  ASSERT_EQ(setup().code, 0);
  scratch_.file("copy.ini", text_of_file(ini()));
  const Finished undone = setup({"--undo"});
  ASSERT_EQ(undone.code, 0) << undone.err;
  EXPECT_THAT(undone.out, HasSubstr("copy.ini loads it, too"));
  EXPECT_TRUE(fs::exists(scratch_.at("m-layer.hal")));
}

// Its HAL file has the layer's instances from the other's setup.
TEST_F(LinuxCncSetup, RefusesAFileThatIsSetUpForAnotherConfiguration) {
  scratch_.file("other.ini", inch_lathe());
  const std::vector<std::string> other{"linuxcnc", "setup", scratch_.at("other.ini")};
  ASSERT_EQ(run(other).code, 0);
  expect_setup_refused("m.hal:3", "is set up for another INI file");
  ASSERT_EQ(run({other[0], other[1], other[2], "--undo"}).code, 0);
  scratch_.file("m.hal", "loadrt mux2 count=2\n");
  ASSERT_EQ(run(other).code, 0);
  expect_setup_refused("m.hal:1", "is set up for another INI file");
}

TEST_F(LinuxCncSetup, DryRunWritesNothing) {
  const Texts before = texts_in(scratch_.path());
  const Finished dry = setup({"--dry-run"});
  EXPECT_EQ(dry.code, 0);
  EXPECT_THAT(dry.out, HasSubstr("+HALFILE = m-layer.hal\n"));
  EXPECT_THAT(dry.out,
              HasSubstr("--- /dev/null\n+++ " + scratch_.at("m-layer.hal") + "\n@@ -0,0 +1,"));
  EXPECT_EQ(texts_in(scratch_.path()), before);
}

struct Conflict {
  const char* hal;
  const char* what;
};

TEST_F(LinuxCncSetup, RefusesWhatIsTaken) {
  for (const Conflict& conflict : {
           Conflict{"loadrt sampler cfg=f depth=100\n", "loads sampler"},
           Conflict{"loadrt watchdog num_inputs=2\n", "loads watchdog"},
           Conflict{"net slow my.ratio => motion.adaptive-feed\n", "drives motion.adaptive-feed"},
           Conflict{"net layer-feed a b\n", "begins with layer- is there already"},
           Conflict{"loadrt sum2 names=layer.tick\n", "begins with layer. is there already"},
           Conflict{"loadrt comp names=a personality=1\n", "which setup cannot extend"},
       }) {
    scratch_.file("m.hal", std::string("\n\n") + conflict.hal);
    expect_setup_refused("m.hal:3", conflict.what);
  }
  scratch_.file("m.hal", "net my-counts a.b axis.z.eoffset-counts\n");
  expect_setup_refused("m.hal:1", "leave --offsets out", {"--offsets"});
  EXPECT_EQ(setup({"--dry-run"}).code, 0) << "without offsets";
}

TEST_F(LinuxCncSetup, RefusesWhatItCannotReadOrPlace) {
  replace("m.ini", "HALFILE = m.hal", "HALFILE = m.tcl");
  expect_setup_refused("m.ini:21", "Tcl");
  replace("m.ini", "HALFILE = m.tcl", "HALFILE =");
  expect_setup_refused("m.ini:21", "is empty");
  replace("m.ini", "HALFILE =\n", "HALFILE = m.hal\nTWOPASS = on\n");
  expect_setup_refused("m.ini:22", "TWOPASS");
  replace("m.ini", "HALFILE = m.hal\nTWOPASS = on", "HALFILE = m.hal\nPOSTGUI_HALFILE = gui.hal");
  scratch_.file("gui.hal", "loadrt sum2 names=mine\n");
  expect_setup_refused("gui.hal:1", "after the layer's HAL file needs it");
  scratch_.file("gui.hal", "");
  scratch_.file("m-layer.hal", "mine\n");
  expect_setup_refused("m-layer.hal", "is not as setup wrote it");
  fs::remove(scratch_.at("m-layer.hal"));
  scratch_.file("hal.inc", "[HAL]\nHALFILE = m.hal\n[X]\n");
  replace("m.ini", "[HAL]\nHALFILE = m.hal\n", "#INCLUDE hal.inc\n");
  expect_setup_refused("hal.inc:2", "in an included file");
}

// A section that an included file leaves open takes the layer's line behind the #INCLUDE.
TEST_F(LinuxCncSetup, PutsItsLineBehindAnInclude) {
  scratch_.file("hal.inc", "[HAL]\nHALFILE = m.hal\n");
  replace("m.ini", "[HAL]\nHALFILE = m.hal\n", "#INCLUDE hal.inc\n");
  const Texts before = texts_in(scratch_.path());
  ASSERT_EQ(setup().code, 0);
  EXPECT_THAT(text_of_file(ini()), HasSubstr("#INCLUDE hal.inc\n# steadyrest begin"));
  EXPECT_EQ(text_of_file(scratch_.at("hal.inc")), before.at("hal.inc"));
  ASSERT_EQ(setup({"--undo"}).code, 0);
  EXPECT_EQ(texts_in(scratch_.path()), before);
}

// A backslash continues the line: all of it makes way for the copy's.
TEST_F(LinuxCncSetup, TakesTheWholeLineThatNamesALibraryFile) {
  if (!fs::exists("/usr/share/linuxcnc/hallib/sim_spindle_encoder.hal")) {
    GTEST_SKIP() << "LinuxCNC's library is not installed";
  }
  replace("m.ini", "HALFILE = m.hal\n", "HALFILE = \\\nsim_spindle_encoder.hal\n");
  const Texts before = texts_in(scratch_.path());
  const Finished done = setup();
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(text_of_file(ini()), HasSubstr("HALFILE = m-layer-sim_spindle_encoder.hal\n"));
  EXPECT_THAT(text_of_file(ini()), Not(HasSubstr("\nsim_spindle_encoder.hal\n")));
  ASSERT_EQ(setup({"--undo"}).code, 0);
  EXPECT_EQ(texts_in(scratch_.path()), before);
}

TEST(LinuxCncSetupStock, LeavesThePackageAlone) {
  const auto inis = stock_inis();
  if (inis.empty()) {
    GTEST_SKIP() << "the sample configurations of LinuxCNC are not installed";
  }
  const std::string ini = "/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/axis_mm.ini";
  ASSERT_TRUE(fs::exists(ini));
  expect_refused("linuxcnc setup " + ini,
                 "belongs to an installed package; copy the configuration");
}

}  // namespace
}  // namespace steadyrest::test
