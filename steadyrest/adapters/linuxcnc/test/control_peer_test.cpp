// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

const std::string kLine =
    R"({"version":"2.9.4","ini":"/c/mill.ini","program":"/nc/part.ngc","text_is_file":false,"stopped":true,"position":[1,2,3,4,5,6,7,8,9],"work_offset":2,)"
    R"("work_offset_mm":[10,20,30,0,0,0,0,0,0],"rotation_deg":5,"g92_mm":[0,0,0,0,0,0,0,0,0],)"
    R"("tool_offset_mm":[0,0,12.5,0,0,0,0,0,0],"tool":3,"tools":[{"number":3,"offset":)"
    R"([0,0,12.5,0,0,0,0,0,0],"diameter_mm":6,"front_deg":0,"back_deg":0,"orientation":0}],)"
    R"("block_delete":true,"inch":false,"incremental":true,"plane":"zx","retract_to_initial":true,"centre_absolute":false,)"
    R"("selected_tool":5,"unread":"G93","path_mode":"continuous","path_tolerance_mm":0.01,)"
    R"("machine_inch":false,"variables":"/nc/a.var","folders":["/nc","/sub"]})";

TEST(ControlState, ReadsALineOfTheScript) {
  const auto state = control_state(kLine);
  ASSERT_TRUE(state.has_value()) << state.error().what;
  EXPECT_EQ(state->version, "2.9.4");
  EXPECT_EQ(state->ini, "/c/mill.ini");
  EXPECT_EQ(state->program, "/nc/part.ngc");
  EXPECT_FALSE(state->text_is_file);
  EXPECT_EQ(state->position[8], 9.0);
  EXPECT_EQ(state->work_offset, 2);
  EXPECT_EQ(state->work_offset_mm[1], 20.0);
  EXPECT_EQ(state->tools.at(0).diameter_mm, 6.0);
  EXPECT_EQ(state->folders.at(1), "/sub");
  EXPECT_EQ(state->path_tolerance_mm, 0.01);
  EXPECT_EQ(state->plane, "zx");
  EXPECT_TRUE(state->retract_to_initial);
  EXPECT_EQ(state->selected_tool, 5);
  EXPECT_EQ(state->unread, "G93");
}

TEST(ControlState, RefusesWhatIsNoLineOfTheScript) {
  for (const std::string line : {"", "{", "[]", "{\"program\":1}", "null", "{}"}) {
    const auto state = control_state(line);
    ASSERT_FALSE(state.has_value()) << line;
    EXPECT_NE(state.error().what.find("not understood"), std::string::npos) << line;
  }
  const auto failed = control_state(R"({"error":"no channel"})");
  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(failed.error().what, "no channel");
}

/// The first state within ten seconds.
kernel::outcome::Result<std::optional<ControlState>> first_of(ControlPeer& peer) {
  for (int i = 0; i < 100; ++i) {
    if (auto state = peer.next(0.1); !state || *state) {
      return state;
    }
  }
  return std::optional<ControlState>();
}

TEST(ControlPeer, HandsOutTheNewestOfSeveralLines) {
  const std::string script =
      "old = '''" + kLine +
      "'''\n"
      "import os; os.write(1, (old + chr(10) + old.replace('part', 'next') + chr(10)).encode())\n"
      "import time; time.sleep(60)\n";
  const auto peer = ControlPeer::start({.script = script});
  ASSERT_TRUE(peer.has_value()) << peer.error().what;
  const auto state = first_of(**peer);
  ASSERT_TRUE(state.has_value()) << state.error().what;
  ASSERT_TRUE(state->has_value());
  EXPECT_EQ((*state)->program, "/nc/next.ngc");
  const auto none = (*peer)->next(0.0);
  EXPECT_TRUE(none.has_value() && !none->has_value());
}

TEST(ControlPeer, SaysThatItsProcessHasEnded) {
  const auto peer = ControlPeer::start({.script = "pass"});
  ASSERT_TRUE(peer.has_value());
  const auto state = first_of(**peer);
  ASSERT_FALSE(state.has_value());
  EXPECT_NE(state.error().what.find("has ended"), std::string::npos);
}

TEST(ControlPeer, RefusesAPythonThatIsNotThere) {
  const auto peer = ControlPeer::start({.python = "/no/python3"});
  ASSERT_FALSE(peer.has_value());
  EXPECT_NE(peer.error().what.find("/no/python3 does not start"), std::string::npos);
}

TEST(ControlPeer, ItsOwnScriptSaysWhyItCannotRead) {
  // Without LinuxCNC there is no channel, or no module.
  const auto peer = ControlPeer::start({});
  ASSERT_TRUE(peer.has_value());
  const auto state = first_of(**peer);
  ASSERT_FALSE(state.has_value());
  EXPECT_NE(state.error().what.find("LinuxCNC's"), std::string::npos) << state.error().what;
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
