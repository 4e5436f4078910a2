// SPDX-License-Identifier: Apache-2.0
// What `steadyrest run` says of the program that a real LinuxCNC has loaded, and of a machine file
// that is not of this control.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/linuxcnc/live_mill.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using nlohmann::json;
using testing::HasSubstr;

std::string words(const json& said, const char* step) {
  return said[step].value("words", json()).is_string() ? said[step]["words"].get<std::string>()
                                                       : std::string();
}

TEST(FollowOnLinuxCnc, SaysWhatIsKnownOfTheLoadedProgram) {
  const OwnFolder folder;
  linuxcnc_test::write_mill(folder.at("machine.toml"));
  std::ofstream(folder.at("unused.ngc")) << "G21\n";
  const int status =
      linuxcnc_test::run_on_linuxcnc(folder, {.script = "follow.py", .program = "unused.ngc"});
  if (status == linuxcnc_test::kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(status, 0);
  const json said = json::parse(text_of_file(folder.at("said.json")), nullptr, false);
  ASSERT_TRUE(said.is_object());
  EXPECT_EQ(said["refused"]["code"], 2);
  EXPECT_THAT(said["refused"]["words"].get<std::string>(),
              HasSubstr("servo_period_ms is 2, LinuxCNC's servo period 1 ms"));
  EXPECT_GT(said["opened"]["segments"], 10);
  // LinuxCNC has the old text open and would run it.
  EXPECT_THAT(words(said, "replaced"), HasSubstr("since the control opened it"));
  EXPECT_GT(said["opened_again"]["segments"], 10);
  EXPECT_EQ(said["run"]["place"], "on_path");
  // Started at the second line of a square that is cut three times: which one is not known.
  EXPECT_EQ(said["searched"]["place"], "searching");
  EXPECT_NE(said["from_line"]["place"], "on_path");
  // Its memory may hold any #31.
  EXPECT_THAT(words(said, "kept"), HasSubstr("part.ngc:3: `X#31`"));
  // G91: the path is known where its start was seen, and only there.
  EXPECT_EQ(said["relative"]["place"], "on_path");
  EXPECT_EQ(said["joined"]["place"], "start_unseen");
  EXPECT_THAT(words(said, "joined"), HasSubstr("that was not seen"));
  const json& answer = said["answer"];
  EXPECT_EQ(answer["handed_back"], true);
  EXPECT_TRUE(answer["stalls"]["lost"].is_number()) << answer;
  for (const json& finding : answer["findings"]) {
    EXPECT_NE(finding["check"], "control") << finding;
  }
}

}  // namespace
}  // namespace steadyrest
