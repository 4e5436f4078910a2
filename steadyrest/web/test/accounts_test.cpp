// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/web/accounts.hpp>

namespace steadyrest::web {
namespace {

using testing::HasSubstr;

class AccountsFile : public testing::Test {
 protected:
  kernel::file::testing::OwnFolder folder;
  std::string file = folder.at("accounts.json");

  std::string text() const { return kernel::file::testing::text_of_file(file); }
};

TEST_F(AccountsFile, KnowsItsUsersAndTokensAgain) {
  Accounts accounts;
  ASSERT_TRUE(accounts.set_user("anna", "correct horse", Role::engineer));
  const auto token = accounts.set_token("logger", Role::viewer);
  ASSERT_TRUE(token.has_value());
  ASSERT_TRUE(accounts.write(file));
  const auto read = Accounts::read(file);
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(read->check("anna", "correct horse"), (Caller{"anna", Role::engineer}));
  EXPECT_EQ(read->check("anna", "correct horsf"), std::nullopt);
  EXPECT_EQ(read->check("bert", "correct horse"), std::nullopt);
  EXPECT_EQ(read->of_token(*token), (Caller{"logger", Role::viewer}));
  EXPECT_EQ(read->of_token((token->front() == 'x' ? "y" : "x") + token->substr(1)), std::nullopt);
  EXPECT_EQ(read->of_token(""), std::nullopt);
}

TEST_F(AccountsFile, HoldsNoSecretAndIsItsOwnersAlone) {
  Accounts accounts;
  ASSERT_TRUE(accounts.set_user("anna", "correct horse", Role::viewer));
  const auto token = accounts.set_token("logger", Role::viewer);
  ASSERT_TRUE(accounts.write(file));
  EXPECT_THAT(text(), HasSubstr("$argon2id$"));
  EXPECT_THAT(text(), Not(HasSubstr("correct horse")));
  EXPECT_THAT(text(), Not(HasSubstr(*token)));
  struct stat status{};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  ::chmod(file.c_str(), 0644);
  const auto open = Accounts::read(file);
  ASSERT_FALSE(open.has_value());
  EXPECT_THAT(open.error().what, HasSubstr("other users may open it"));
}

TEST_F(AccountsFile, ReplacesAndRemoves) {
  Accounts accounts;
  ASSERT_TRUE(accounts.set_user("anna", "correct horse", Role::engineer));
  ASSERT_TRUE(accounts.set_user("anna", "battery staple", Role::viewer));
  EXPECT_EQ(accounts.users().size(), 1U);
  EXPECT_EQ(accounts.check("anna", "correct horse"), std::nullopt);
  EXPECT_EQ(accounts.check("anna", "battery staple"), (Caller{"anna", Role::viewer}));
  EXPECT_TRUE(accounts.remove_user("anna"));
  EXPECT_FALSE(accounts.remove_user("anna"));
  EXPECT_EQ(accounts.check("anna", "battery staple"), std::nullopt);
}

TEST_F(AccountsFile, RefusesWeakPasswordsAndOddNames) {
  Accounts accounts;
  EXPECT_FALSE(accounts.set_user("anna", "short", Role::viewer));
  EXPECT_FALSE(accounts.set_user("", "long enough", Role::viewer));
  EXPECT_FALSE(accounts.set_user("an na", "long enough", Role::viewer));
  EXPECT_FALSE(accounts.set_token("a/b", Role::viewer));
  EXPECT_FALSE(accounts.set_user(std::string(33, 'a'), "long enough", Role::viewer));
}

TEST_F(AccountsFile, RefusesWhatIsNoneOfIt) {
  EXPECT_FALSE(Accounts::read(file));
  for (const char* const wrong :
       {"", "[]", "{}", R"({"version":2})", R"({"version":1,"users":{}})",
        R"({"version":1,"users":[1]})",
        R"({"version":1,"users":[{"name":"a","role":"god","argon2id":"x"}]})",
        R"({"version":1,"tokens":[{"name":"a","role":"viewer"}]})"}) {
    std::ofstream(file) << wrong;
    ::chmod(file.c_str(), 0600);
    EXPECT_FALSE(Accounts::read(file)) << wrong;
  }
}

}  // namespace
}  // namespace steadyrest::web
