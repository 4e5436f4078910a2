// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::file::testing::OwnFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A configuration whose one HAL file has this text.
class HalUseTest : public testing::Test {
 protected:
  kernel::outcome::Result<HalUse> use(const std::string& hal, const std::string& more_ini = "") {
    folder_.file("m.hal", hal);
    ini_ = IniFile::parse("[HAL]\nHALFILE = m.hal\n" + more_ini, folder_.at("m.ini"));
    return HalUse::of(*ini_);
  }
  OwnFolder folder_;
  kernel::outcome::Result<IniFile> ini_ = IniFile::parse("[A]\n", "");
};

TEST_F(HalUseTest, SeesComponentsByNameAndNumber) {
  const auto seen =
      use("loadrt sum2 names=a,b\nloadrt mux2\nloadrt comp \\\n  count=[KINS]JOINTS # three\n"
          "# loadrt mult2\nloadrt limit2 count=[NO](WHERE)\n",
          "[KINS]\nJOINTS = 3\n");
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->loaded("sum2")->names, ElementsAre("a", "b"));
  EXPECT_EQ(seen->loaded("mux2")->count, 1U);
  EXPECT_EQ(seen->loaded("comp")->count, 3U);
  EXPECT_EQ(seen->loaded("comp")->where.line, 3U);
  EXPECT_EQ(seen->loaded("comp")->where.last, 4U);
  EXPECT_EQ(seen->loaded("mult2"), nullptr);
  EXPECT_THAT(seen->loaded("limit2")->others, ElementsAre("count=[NO](WHERE)"));
}

TEST_F(HalUseTest, AValueThatNamesItsOwnKeyIsPutInOnce) {
  const auto seen = use("loadrt comp [S]K [S](L)[S]N\n", "[S]\nK = x[S]K\nL = [S]L,\nN = 1\n");
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->loaded("comp")->others, ElementsAre("x[S]K", "[S]L,1"));
}

TEST_F(HalUseTest, SeesSignalsByEveryCommandThatConnects) {
  folder_.file("more.hal", "net s6 pin.6\n");
  const auto seen = use(
      "net s1 pin.1 => pin.2\nlinkps pin.3 => s3\nlinksp s4 => pin.4\nnet s5 pin.5\nunlinkp pin.5\n"
      "source more.hal\nalias pin pin.7 nick\nnet s7 nick\n",
      "POSTGUI_HALFILE = gui.hal\n" + (folder_.file("gui.hal", "net s8 pin.8\n"), std::string()));
  ASSERT_TRUE(seen) << seen.error().what;
  EXPECT_THAT(seen->signals(),
              ElementsAre(testing::Pair("pin.1", "s1"), testing::Pair("pin.2", "s1"),
                          testing::Pair("pin.3", "s3"), testing::Pair("pin.4", "s4"),
                          testing::Pair("pin.6", "s6"), testing::Pair("pin.7", "s7"),
                          testing::Pair("pin.8", "s8")));
  EXPECT_TRUE(seen->linked("pin.6")->where.sourced);
  EXPECT_EQ(seen->linked("pin.8")->where.stage, Where::Stage::after);
  EXPECT_NE(seen->named("s7"), nullptr);
  EXPECT_EQ(seen->named("t"), nullptr);
}

TEST_F(HalUseTest, RefusesWhatItCannotRead) {
  const auto refused = [this](const std::string& hal, const std::string& ini, const char* what) {
    const auto seen = use(hal, ini);
    ASSERT_FALSE(seen) << ini;
    EXPECT_THAT(seen.error().what, HasSubstr(what));
    EXPECT_GT(seen.error().line, 0U);
    EXPECT_FALSE(seen.error().to_do.empty());
  };
  refused("", "HALFILE = x.tcl\n", "Tcl");
  refused("", "HALFILE = LIB:basic_sim.tcl -no_make_ddts\n", "Tcl");
  refused("", "TWOPASS = on\n", "TWOPASS");
  refused("", "HALFILE = none.hal\n", "neither beside the INI file nor in");
  refused("net a b\nsource none.hal\n", "", "neither beside the INI file nor in");
  refused("source m.hal\n", "", "8 files deep");
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc::config
