// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
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

/// control_state.py's OpenedText on a made-up /proc, in which 7 is LinuxCNC's task; what `asked`
/// leaves in `said` comes back as the words of an error.
std::string said(const std::string& asked) {
  const kernel::file::testing::OwnFolder folder;
  const std::string script = "folder, source = '" + folder.path().string() +
                             "', '" STEADYREST_SOURCE_DIR
                             "/steadyrest/adapters/linuxcnc/control_state.py'\n" +
                             R"(
import json, os, sys, types
sys.modules['linuxcnc'] = sys.modules['hal'] = types.ModuleType('none')
exec(open(source).read().split('try:\n    watch()')[0])
os.chdir(folder)
text, part, said = OpenedText('milltask', folder + '/proc'), folder + '/part.ngc', []
def process(number, name):
    os.makedirs('proc/%d/fd' % number)
    open('proc/%d/comm' % number, 'w').write(name + '\n')
def write(name):
    open(name, 'w').write('M2\n')
process(7, 'milltask')
write(part)
)" + asked + "print(json.dumps({'error': ' '.join(map(str, said))}), flush=True)\n";
  const auto peer = ControlPeer::start({.script = script}).value();
  const auto state = first_of(*peer);
  return state ? "none" : state.error().what;
}

// A plain file cannot be read as a link, as a descriptor that has just been closed.
TEST(ControlScript, AVanishedDescriptorLeavesTheVerdictOnTheText) {
  EXPECT_EQ(said(R"(
for i in range(16): write('proc/7/fd/%d' % i)
os.symlink(part, 'proc/7/fd/20')
said.append(text.is_file(part, True))
os.rename(part, 'part.ngc (deleted)')
write(part)
os.remove('proc/7/fd/20')
os.symlink(part + ' (deleted)', 'proc/7/fd/20')
said.append(text.is_file(part, True))
os.remove('proc/7/fd/20')
said.append(text.is_file(part, True))
said.append(text.is_file(folder + '/next.ngc', True))
)"),
            "True False False True");
}

TEST(ControlScript, LooksForTheTaskOnlyWhereItHasGone) {
  EXPECT_EQ(said(R"(
for i in range(20, 30): process(i, 'other')
os.symlink(part, 'proc/7/fd/3')
is_task, looked = text.is_task, []
text.is_task = lambda process: looked.append(process) or is_task(process)
text.is_file(part, True)
looked.clear()
said += [text.is_file(part, True), len(looked)]
said += [text.is_file(part, False), len(looked)]
open('proc/7/comm', 'w').write('bash')
process(8, 'milltask')
said += [text.is_file(part, True), text.process.endswith('/8')]
)"),
            "True 0 True 1 True True");
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
