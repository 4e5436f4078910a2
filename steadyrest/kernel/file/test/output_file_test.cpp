// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <string>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/test/output_scene.hpp>

namespace steadyrest::kernel::file {
namespace {

namespace fs = std::filesystem;
using test::in_child;
using test::Output;

// Flushed is not committed: the target must remain the old file until the end.
TEST_F(Output, ReplacesAtTheEndAndNotBefore) {
  const std::string file = old("out.csv");
  auto out = OutputFile::open(file);
  ASSERT_TRUE(out.has_value());
  out->write("new\n");
  ASSERT_TRUE(out->flush().has_value());
  EXPECT_EQ(text_of(out->path()), "new\n");
  EXPECT_EQ(text_of(file), "old\n");
  ASSERT_TRUE(out->commit().has_value());
  EXPECT_EQ(text_of(file), "new\n");
  EXPECT_EQ(entries(), 1);
  EXPECT_EQ(written_files().back().file, file);
  EXPECT_EQ(written_files().back().bytes, 4U);
  EXPECT_EQ(written_files().back().lines, 1U);
}

// A megabyte, so that the buffer is written out several times.
TEST_F(Output, LeavesNothingWithoutCommit) {
  const std::string file = old("out.csv");
  {
    auto out = OutputFile::open(file);
    ASSERT_TRUE(out.has_value());
    out->write(std::string(std::size_t{1} << 20U, 'x'));
  }
  EXPECT_EQ(text_of(file), "old\n");
  EXPECT_EQ(entries(), 1);
}

// Two links deep: a rename onto the link would replace the link.
TEST_F(Output, KeepsRightsAndFollowsLinks) {
  const std::string file = old("machine.toml");
  ASSERT_EQ(chmod(file.c_str(), 0640), 0);
  fs::create_symlink("machine.toml", at("link"));
  fs::create_symlink("link", at("link-of-link"));
  ASSERT_TRUE(write_file(at("link-of-link"), "new\n").has_value());
  EXPECT_TRUE(fs::is_symlink(at("link")));
  EXPECT_TRUE(fs::is_symlink(at("link-of-link")));
  EXPECT_EQ(text_of(file), "new\n");
  struct ::stat now{};
  ASSERT_EQ(stat(file.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
}

// canonical() would refuse a link whose target does not exist.
TEST_F(Output, FollowsALinkToAFileThatIsYetToCome) {
  fs::create_directory(at("deep"));
  fs::create_symlink("deep/out.csv", at("link"));
  ASSERT_TRUE(write_file(at("link"), "new\n").has_value());
  EXPECT_TRUE(fs::is_symlink(at("link")));
  EXPECT_EQ(text_of(at("deep/out.csv")), "new\n");
}

// The price of the rename, stated: other hard links stay with the old inode.
TEST_F(Output, AnotherHardLinkKeepsTheOldContent) {
  const std::string file = old("out.csv");
  fs::create_hard_link(file, at("copy"));
  ASSERT_TRUE(write_file(file, "new\n").has_value());
  EXPECT_EQ(text_of(file), "new\n");
  EXPECT_EQ(text_of(at("copy")), "old\n");
}

// A folder entry holds 255 bytes: the temporary name must not be longer than the target's.
TEST_F(Output, TakesTheLongestName) {
  const std::string file = at(std::string(255, 'n'));
  ASSERT_TRUE(write_file(file, "new\n").has_value());
  EXPECT_EQ(text_of(file), "new\n");
}

TEST_F(Output, CanBeReadByAChildBeforeItHasAName) {
  auto out = OutputFile::open(at("out.csv"));
  ASSERT_TRUE(out.has_value());
  out->write("new\n");
  ASSERT_TRUE(out->flush().has_value());
  EXPECT_EQ(std::system(("cp " + out->path() + " " + at("copy")).c_str()), 0);
  EXPECT_EQ(text_of(at("copy")), "new\n");
}

// Declared outputs wait for the end; scratch files do not. In a child, since the ledger belongs to
// the process.
TEST_F(Output, OfAProgramTakesItsPlaceWithTheOthers) {
  const std::string first = old("a.csv");
  const auto ends_with = [&](bool placed) {
    return in_child([&] {
      const std::vector<std::string> outputs = {first, at("b.csv")};
      const std::size_t before = written_files().size();
      declare_outputs(outputs);
      if (!write_file(at("scratch"), "read back\n") || text_of(at("scratch")) != "read back\n") {
        _exit(1);
      }
      fs::remove(at("scratch"));
      if (!write_file(first, "new\n") || !write_file(at("b.csv"), "new\n") ||
          text_of(first) != "old\n" || entries() != 1 || written_files().size() != before) {
        _exit(1);
      }
      if (placed && (!put_outputs_in_place() || written_files().size() != before + 2)) {
        _exit(1);
      }
    });
  };
  EXPECT_EQ(ends_with(false), 0);
  EXPECT_EQ(text_of(first), "old\n");
  EXPECT_EQ(entries(), 1);
  EXPECT_EQ(ends_with(true), 0);
  EXPECT_EQ(text_of(first), "new\n");
  EXPECT_EQ(text_of(at("b.csv")), "new\n");
  EXPECT_EQ(entries(), 2);
}

// The third rename fails (a folder of that name turned up). The first must be the old file again,
// and the second gone.
TEST_F(Output, IsTakenBackWhereAnotherCannotTakeItsPlace) {
  const std::string first = old("a.csv");
  std::vector<OutputFile> out;
  for (const std::string& file : {first, at("new.csv"), at("folder")}) {
    out.push_back(std::move(OutputFile::open(file).value()));
    out.back().write("new\n");
    ASSERT_TRUE(out.back().settle().has_value());
  }
  fs::create_directory(at("folder"));
  const auto put = put_in_place(out);
  ASSERT_FALSE(put.has_value());
  EXPECT_EQ(put.error().file, at("folder"));
  out.clear();
  EXPECT_EQ(text_of(first), "old\n");
  EXPECT_EQ(entries(), 2);
}

TEST_F(Output, RenamesNoneBeforeAllAreWritten) {
  const std::string first = old("a.csv");
  const std::vector<FileText> files = {{first, "new\n"}, {at("missing/b.csv"), "new\n"}};
  const auto written = write_files(files);
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().file, at("missing/b.csv"));
  EXPECT_EQ(text_of(first), "old\n");
  EXPECT_EQ(entries(), 1);
}

// RLIMIT_FSIZE behaves like a full disk: write() fails after 1000 bytes.
TEST_F(Output, AFullDiskLeavesTheOldFile) {
  const std::string file = old("out.csv");
  const int status = in_child([&] {
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    auto out = OutputFile::open(file);
    out->write(std::string(5000, 'x'));
    const auto done = out->commit();
    _exit(!done && done.error().kind == outcome::Kind::unavailable &&
                  done.error().what.starts_with("write failed")
              ? 7
              : 8);
  });
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(text_of(file), "old\n");
}

TEST_F(Output, APipeIsWrittenOnceItHasAReaderAndRefusedWithoutOne) {
  const std::string pipe = at("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto nobody = OutputFile::open(pipe);
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().what.find("no program reads"), std::string::npos);
  auto got = std::async(std::launch::async, [&] { return text_of(pipe); });
  auto file = OutputFile::open(pipe);
  ASSERT_TRUE(file) << file.error().what;
  const std::string large(1 << 20, 'x');  // more than a pipe holds
  file->write(large);
  EXPECT_TRUE(file->commit());
  {
    const OutputFile closed = std::move(*file);
  }
  EXPECT_EQ(got.get(), large);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Output, ASocketOrAFolderIsRefused) {
  const std::string name = at("socket");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const std::string& target : {name, folder_.path().string(), at("none/file")}) {
    EXPECT_FALSE(OutputFile::open(target)) << target;
  }
  ::close(socket);
  auto full = OutputFile::open("/dev/full");
  ASSERT_TRUE(full);
  full->write("text");
  EXPECT_FALSE(full->commit());
}

TEST_F(Output, AClosedPipeIsARefusal) {
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  const int status = in_child([&] {
    const int reader = open(at("pipe").c_str(), O_RDONLY | O_NONBLOCK);
    auto out = OutputFile::open(at("pipe"));
    close(reader);
    out->write("new\n");
    const auto done = out->commit();
    _exit(!done && done.error().what == "write failed: Broken pipe" ? 7 : 8);
  });
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_TRUE(fs::is_fifo(at("pipe")));
}

// Redirected by >>: a rename would replace the log that the shell writes.
TEST_F(Output, StdoutIsWrittenToEvenWhereItIsAFile) {
  const std::string file = old("log");
  const int status = in_child([&] {
    dup2(open(file.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO);
    auto out = OutputFile::open("/dev/stdout");
    out->write("new\n");
    _exit(out->commit().has_value() ? 7 : 8);
  });
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(text_of(file), "old\nnew\n");
}

// The signal comes before the write, the end after the rename.
TEST_F(Output, SignalsWaitUntilAllHaveTheirPlaces) {
  const int status = in_child([&] {
    const SignalsHeldBack wait;
    raise(SIGINT);
    static_cast<void>(write_file(at("out.csv"), "new\n"));
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
  EXPECT_EQ(text_of(at("out.csv")), "new\n");
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace steadyrest::kernel::file
