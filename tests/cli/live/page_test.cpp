// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "live_layer.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace steadyrest::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kRun =
    "run --machine examples/machines/vmc-840d.toml --program examples/programs/circle-r10.mpf "
    "--for-s 0.2 --socket s ";

TEST(PageAccounts, AreAddedListedAndRemoved) {
  const Scratch own;
  const std::string users = " --users " + own.at("users.json");
  const std::string password = own.file("password", "correct horse\n");
  EXPECT_EQ(run_line_on("page add-user anna --role engineer" + users, password).code, 0);
  EXPECT_EQ(run_line("page add-token logger" + users).code, 0);
  const auto list = answer_of("page list" + users);
  EXPECT_EQ(list["users"][0]["role"], "engineer");
  EXPECT_EQ(list["tokens"][0]["name"], "logger");
  EXPECT_EQ(run_line("page remove anna" + users).code, 0);
  EXPECT_EQ(run_line("page remove anna" + users).code, 2);
  const std::string empty = own.file("empty", "\n");
  const Finished weak = run_line_on("page add-user bert" + users, empty);
  EXPECT_EQ(weak.code, 2);
  EXPECT_THAT(weak.err, HasSubstr("8 … 1024"));
}

TEST(PageOfARun, IsRefusedWhereOthersCouldGetInOrListen) {
  const Finished open = run_line(kRun + "--listen 0.0.0.0:0");
  EXPECT_EQ(open.code, 2);
  EXPECT_THAT(open.err, AllOf(HasSubstr("open to others"), HasSubstr("page add-user")));
  const Scratch own;
  const std::string password = own.file("password", "correct horse\n");
  const std::string users = " --users " + own.at("users.json");
  ASSERT_EQ(run_line_on("page add-user anna" + users, password).code, 0);
  const Finished plain = run_line(kRun + "--listen 0.0.0.0:0" + users);
  EXPECT_EQ(plain.code, 2);
  EXPECT_THAT(plain.err, HasSubstr("unencrypted"));
  EXPECT_EQ(run_line(kRun + "--listen nowhere").code, 2);
  EXPECT_EQ(run_line(kRun + "--listen 127.0.0.1:0 --users /none").code, 2);
}

// stderr may be the journal, which others read. tests of the page read the file while it is there.
TEST(PageOfARun, TellsItsKeyToATerminalAloneAndElseToAFileOfItsUsers) {
  const Finished finished = run_line(kRun + "--listen 0");
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, AllOf(HasSubstr("Page: http://127.0.0.1:"),
                                  HasSubstr("(its address with the key: s.page)")));
  EXPECT_EQ((finished.out + finished.err).find("key="), std::string::npos);
}

TEST(PageOfARun, HasItsKeyInAFileOfItsUserBesideTheSocket) {
  const LiveLayer layer("observe", {"--listen", "0"});
  const std::string file = layer.at("steadyrest.sock.page");
  ASSERT_TRUE(LiveLayer::until([&] { return text_of_file(file).ends_with("\n"); }));
  struct ::stat status{};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_THAT(text_of_file(file), AllOf(HasSubstr("http://127.0.0.1:"), HasSubstr("/#key=")));
}

TEST(PageOfARun, IsRefusedItsOptionsWithoutAPage) {
  for (const std::string option :
       {"--users /none", "--tls-certificate /none", "--tls-key /none", "--past-runs .",
        "--behind-proxy https://mill.example", "--trusted-proxy 10.0.0.7"}) {
    const Finished finished = run_line(kRun + option);
    EXPECT_EQ(finished.code, 2) << option;
    EXPECT_THAT(finished.err, AllOf(HasSubstr(option.substr(0, option.find(' '))),
                                    HasSubstr("give --listen, too")))
        << option;
  }
}

TEST(PageOfARun, ListensByANameOfThisComputer) {
  const Finished named = run_line(kRun + "--listen localhost:0");
  EXPECT_EQ(named.code, 0) << named.err;
  EXPECT_THAT(named.err, HasSubstr("Page: http://localhost:"));
}

TEST(PageOfARun, BehindAProxyThatOthersCanGoAroundTakesTheProxysAddress) {
  const Scratch own;
  const std::string password = own.file("password", "correct horse\n");
  const std::string users = " --users " + own.at("users.json");
  ASSERT_EQ(run_line_on("page add-user anna" + users, password).code, 0);
  const std::string behind = kRun + "--behind-proxy https://mill.example --listen ";
  const Finished open = run_line(behind + "0.0.0.0:0" + users);
  EXPECT_EQ(open.code, 2);
  EXPECT_THAT(open.err, HasSubstr("--trusted-proxy ADDRESS"));
  EXPECT_EQ(run_line(behind + "0.0.0.0:0 --trusted-proxy proxy.example" + users).code, 2);
  const Finished named = run_line(behind + "0.0.0.0:0 --trusted-proxy 10.0.0.7" + users);
  EXPECT_EQ(named.code, 0) << named.err;
  EXPECT_EQ(run_line(behind + "0" + users).code, 0);
}

}  // namespace
}  // namespace steadyrest::test
