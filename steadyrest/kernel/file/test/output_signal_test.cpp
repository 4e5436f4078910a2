// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/test/output_scene.hpp>

namespace steadyrest::kernel::file {
namespace {

namespace fs = std::filesystem;
using test::in_child;
using test::Output;

// Nested folders are removed from the inside out.
TEST_F(Output, SignalsEndTheProcessAndLeaveNoTemporary) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    const std::string file = old("out.csv");
    const int status = in_child([&] {
      const Temporary folder((folder_.path() / "new").string(), Temporary::Kind::folder);
      fs::create_directory(at("new"));
      const Temporary deeper((folder_.path() / "new" / "er").string(), Temporary::Kind::folder);
      fs::create_directory(at("new/er"));
      auto out = OutputFile::open(file);
      out->write("new\n");
      static_cast<void>(out->flush());
      raise(signal);
    });
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
    EXPECT_EQ(text_of(file), "old\n");
    EXPECT_EQ(entries(), 1);
  }
}

// SIGKILL runs no handler: only a file without a name leaves nothing.
TEST_F(Output, SigkillLeavesNothingWhereAFileMayHaveNoName) {
  const int probe = open(folder_.path().c_str(), O_TMPFILE | O_RDWR, 0600);
  if (probe < 0) {
    GTEST_SKIP() << "this file system has no files without a name";
  }
  close(probe);
  const std::string file = old("out.csv");
  const int status = in_child([&] {
    auto out = OutputFile::open(file);
    out->write("new\n");
    static_cast<void>(out->flush());
    raise(SIGKILL);
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(text_of(file), "old\n");
  EXPECT_EQ(entries(), 1);
}

// As nohup starts its children.
TEST_F(Output, AnIgnoredSignalStaysIgnored) {
  const int status = in_child([] {
    signal(SIGHUP, SIG_IGN);
    remove_temporaries_on_signals();
    raise(SIGHUP);
  });
  EXPECT_TRUE(WIFEXITED(status));
}

}  // namespace
}  // namespace steadyrest::kernel::file
