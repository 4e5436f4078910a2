// SPDX-License-Identifier: Apache-2.0
// LinuxCNC starts on configurations that `steadyrest linuxcnc setup` has changed, and the layer's
// pins are there, connected.
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/linuxcnc/live_mill.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest {
namespace {

namespace fs = std::filesystem;
using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using linuxcnc_test::kCannotRun;
using linuxcnc_test::status_of;
using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

/// A copy of a configuration, set up with the built program.
class SetupLoads : public testing::Test {
 protected:
  void copy(const fs::path& folder) {
    fs::create_directory(folder_.path() / "cfg");
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        fs::copy_file(entry.path(), folder_.path() / "cfg" / entry.path().filename());
      }
    }
    before_ = texts();
  }
  std::map<std::string, std::string> texts() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / "cfg")) {
      if (entry.is_regular_file()) {
        out[entry.path().string()] = text_of_file(entry.path());
      }
    }
    return out;
  }
  int setup(const std::string& ini, const std::string& options) const {
    return status_of("'" STEADYREST_PROGRAM "' linuxcnc setup '" + folder_.at("cfg/" + ini) + "' " +
                     options + " >/dev/null");
  }
  /// 0, or why not; then signals_ has what LinuxCNC shows.
  int start(const std::string& ini) {
    const int status = status_of("bash " STEADYREST_SOURCE_DIR "/tests/linuxcnc/loads.sh '" +
                                 folder_.at("cfg/" + ini) + "' '" + folder_.at("shown") + "'");
    std::istringstream in(text_of_file(folder_.at("shown")));
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string owner;
      std::string type;
      std::string direction;
      std::string value;
      std::string name;
      std::string arrow;
      std::string signal;
      words >> owner >> type >> direction >> value >> name >> arrow >> signal;
      if (arrow == "<==" || arrow == "==>") {
        signals_[name] = signal;
      }
    }
    return status;
  }
  /// Every column of the sampler is connected but that of the measured speed, if it is not.
  void expect_samples(std::size_t channel, std::size_t columns, std::size_t but = 99) const {
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string pin = "sampler." + std::to_string(channel) + ".pin." + std::to_string(i);
      EXPECT_EQ(signals_.count(pin), i == but ? 0U : 1U) << pin;
    }
  }
  void expect_undone(const std::string& ini) const {
    EXPECT_EQ(setup(ini, "--undo"), 0);
    EXPECT_EQ(texts(), before_);
  }
  OwnFolder folder_;
  std::map<std::string, std::string> before_;
  std::map<std::string, std::string> signals_;  ///< by pin
};

TEST_F(SetupLoads, TheExampleWithOffsets) {
  copy(STEADYREST_SOURCE_DIR "/examples/linuxcnc");
  ASSERT_EQ(setup("mill.ini", "--offsets"), 0);
  const int status = start("mill.ini");
  if (status == kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(status, 0);
  expect_samples(0, 18);
  expect_samples(1, 13);
  EXPECT_THAT(signals_, Contains(Pair("motion.adaptive-feed", "layer-feed-in-force")));
  EXPECT_THAT(signals_, Contains(Pair("spindle.0.speed-out-rps", "spindle-rps")));
  EXPECT_THAT(signals_, Contains(Pair("layer.drive.in0", "spindle-rps")));
  EXPECT_THAT(signals_, Contains(Pair("halui.mode.is-auto", "layer-is-auto")));
  for (const char* axis : {"x", "y", "z"}) {
    const std::string a = axis;
    EXPECT_THAT(signals_,
                Contains(Pair("axis." + a + ".eoffset-counts", "layer-offset-" + a + "-counts")));
    EXPECT_THAT(signals_, Contains(Pair("axis." + a + ".eoffset", "layer-" + a + "-eoffset")));
  }
  expect_undone("mill.ini");
}

// LinuxCNC's own file loads a limit2, and takes the spindle's speed in rpm.
TEST_F(SetupLoads, AStockConfigurationWithAFileOfLinuxCncsLibrary) {
  const fs::path stock = "/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis";
  if (!fs::exists(stock / "axis_mm.ini")) {
    GTEST_SKIP() << "the sample configurations of LinuxCNC are not installed";
  }
  copy(stock);
  ASSERT_EQ(setup("axis_mm.ini", ""), 0);
  EXPECT_THAT(
      text_of_file(folder_.at("cfg/axis_mm-layer-sim_spindle_encoder.hal")),
      HasSubstr(
          "loadrt limit2 names=limit_speed,layer.feed-ramp,layer.feed-most,layer.spindle-ramp\n"));
  const int status = start("axis_mm.ini");
  if (status == kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(status, 0);
  expect_samples(0, 18);
  expect_samples(1, 13);
  EXPECT_THAT(signals_, Contains(Pair("layer.drive-rpm.in0", "spindle-speed-cmd")));
  EXPECT_THAT(signals_, Contains(Pair("layer.drive-rpm.out", "layer-drive-rpm")));
  EXPECT_THAT(signals_, Contains(Pair("sampler.0.pin.7", "spindle-rps-filtered")));
  EXPECT_THAT(signals_, Contains(Pair("limit_speed.in", "spindle-speed-cmd")));
  expect_undone("axis_mm.ini");
}

}  // namespace
}  // namespace steadyrest
