// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(PageOfARun, IsAnnouncedWithItsKeyOnStderrAlone) {
  const Finished finished = run_line(kRun + "--listen 0");
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("Page: http://127.0.0.1:"));
  EXPECT_EQ(finished.out.find("#key="), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::test
