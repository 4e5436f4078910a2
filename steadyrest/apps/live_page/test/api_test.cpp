// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/assets.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Mode;
using test::PageDesk;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;
using testing::Pair;
using web::Role;

/// An address of this route that exists, or could.
std::string address_of(const Route& route) {
  return std::string(route.path) + (!route.path.ends_with('/') ? ""
                                    : route.method == "POST"   ? "x/replay"
                                                               : "x");
}

class PageApi : public testing::Test {
 protected:
  PageApi() {
    web::Accounts accounts;
    for (const auto& [name, role] :
         {std::pair("vera", Role::viewer), {"otto", Role::operating}, {"anna", Role::engineer}}) {
      EXPECT_TRUE(accounts.set_user(name, "secret of " + std::string(name), role));
    }
    token = accounts.set_token("script", Role::operating).value();
    EXPECT_TRUE(accounts.write(file));
  }
  void log_in(const std::string& name) {
    desk.log_in(Json{{"name", name}, {"password", "secret of " + name}}.dump());
    ASSERT_FALSE(desk.cookie().empty());
  }

  kernel::file::testing::OwnFolder folder;
  std::string file = folder.at("users.json");
  std::string token;
  PageDesk desk{file};
};

TEST_F(PageApi, GivesNothingBeforeALogIn) {
  for (const Route& route : Api::routes()) {
    const auto got = desk.ask(std::string(route.method), address_of(route), "{}");
    EXPECT_EQ(got.status == 401, !route.open || route.method == "POST")
        << route.method << route.path;
  }
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::observe);
  auto stream = desk.api().admit(PageDesk::request("GET", "/api/v1/stream"));
  ASSERT_TRUE(std::holds_alternative<web::Response>(stream));
  EXPECT_EQ(std::get<web::Response>(stream).status, 401U);
}

TEST_F(PageApi, LetsEachRoleDoWhatItMay) {
  for (const auto& [name, role] :
       {std::pair("vera", Role::viewer), {"otto", Role::operating}, {"anna", Role::engineer}}) {
    log_in(name);
    for (const Route& route : Api::routes()) {
      if (route.method == "DELETE" || route.path == "/api/v1/session") {
        continue;
      }
      const auto got = desk.ask(std::string(route.method), address_of(route), "{}");
      EXPECT_EQ(got.status == 403, role < route.role) << name << " " << route.path;
      EXPECT_NE(got.status, 401U) << name << " " << route.path;
    }
  }
}

TEST_F(PageApi, TakesNoWriteWithoutTheSessionsOwnWord) {
  log_in("anna");
  web::Request request = PageDesk::request("POST", "/api/v1/mode", R"({"mode":"advise"})");
  request.cookie = desk.cookie();
  EXPECT_EQ(desk.api().answer(request).status, 403U);
  request.csrf = desk.csrf().substr(1) + "x";
  EXPECT_EQ(desk.api().answer(request).status, 403U);
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::observe);
  request.csrf = desk.csrf();
  request.content_type = "text/plain";
  EXPECT_EQ(desk.api().answer(request).status, 415U);
  request.content_type = "Application/JSON; charset=utf-8";
  EXPECT_EQ(desk.api().answer(request).status, 200U);
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::advise);
}

TEST_F(PageApi, LetsAScriptInByItsToken) {
  web::Request request = PageDesk::request("POST", "/api/v1/mode", R"({"mode":"advise"})");
  request.authorization = "Bearer " + token;
  EXPECT_EQ(desk.api().answer(request).status, 200U);
  request.authorization = "bearer " + token;
  EXPECT_EQ(desk.api().answer(request).status, 200U);
  request.path = "/api/v1/machine/apply";
  EXPECT_EQ(desk.api().answer(request).status, 403U) << "an operator's token";
  request.authorization = "Bearer " + token.substr(1) + "x";
  EXPECT_EQ(desk.api().answer(request).status, 401U);
  request.authorization = "Bearer " + token;
  auto stream = desk.api().admit(request);
  ASSERT_TRUE(std::holds_alternative<web::Server::Admitted>(stream));
  EXPECT_TRUE(std::get<web::Server::Admitted>(stream).goes_on());
  auto accounts = web::Accounts::read(file).value();
  accounts.remove_token("script");
  ASSERT_TRUE(accounts.write(file));
  EXPECT_FALSE(std::get<web::Server::Admitted>(stream).goes_on());
  EXPECT_EQ(desk.api().answer(request).status, 401U);
}

TEST_F(PageApi, ActTakesAConfirmationAndHandingBackNone) {
  log_in("otto");
  EXPECT_EQ(desk.ask("POST", "/api/v1/mode", R"({"mode":"act"})").status, 422U);
  EXPECT_EQ(desk.ask("POST", "/api/v1/mode", R"({"mode":"go"})").status, 422U);
  EXPECT_EQ(desk.ask("POST", "/api/v1/mode", "[]").status, 400U);
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::observe);
  EXPECT_EQ(desk.ask("POST", "/api/v1/mode", R"({"mode":"act","confirm":true})").status, 200U);
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::act);
  log_in("vera");
  EXPECT_EQ(desk.ask("POST", "/api/v1/hand-back", "{}").status, 200U);
  EXPECT_EQ(desk.loop().mode_wanted(), Mode::observe);
  desk.loop().run();
  EXPECT_THAT(desk.notes, ElementsAre("page: otto (operator) asked for act",
                                      "page: vera (viewer) handed back"));
}

TEST_F(PageApi, SlowsDownWhoeverGuesses) {
  for (int i = 0; i < 5; ++i) {
    const auto got =
        desk.ask("POST", "/api/v1/session", R"({"name":"anna","password":"guess me"})");
    EXPECT_EQ(got.status, 401U);
  }
  const std::string right = R"({"name":"anna","password":"secret of anna"})";
  auto got = desk.ask("POST", "/api/v1/session", right);
  EXPECT_EQ(got.status, 429U);
  EXPECT_THAT(got.head, Contains(Key("Retry-After")));
  web::Request elsewhere = PageDesk::request("POST", "/api/v1/session", right);
  elsewhere.address = "10.0.0.7";
  EXPECT_EQ(desk.answered(elsewhere).status, 429U) << "the account is shut from everywhere";
  elsewhere.body = R"({"name":"otto","password":"secret of otto"})";
  EXPECT_EQ(desk.answered(elsewhere).status, 200U);
  desk.now_s = 13.0;
  EXPECT_EQ(desk.ask("POST", "/api/v1/session", right).status, 200U);
}

// Else each made-up name would be kept whole.
TEST_F(PageApi, CountsNamesNoLongerThanAnAccounts) {
  for (int i = 0; i < 6; ++i) {
    auto request = PageDesk::request(
        "POST", "/api/v1/session",
        Json{{"name", std::string(5000, 'x') + std::to_string(i)}, {"password", "p"}}.dump());
    request.address = "10.0.0." + std::to_string(i);
    EXPECT_EQ(desk.answered(request).status, i < 5 ? 401U : 429U) << i;
  }
}

// The queue for hashing is short: nothing else may wait in it.
TEST_F(PageApi, ReadsALogInOfBoundedLengthAndHashesBesideOtherAnswers) {
  const auto asked = [](const std::string& name) {
    return PageDesk::request("POST", "/api/v1/session",
                             Json{{"name", name}, {"password", "secret of anna"}}.dump());
  };
  const web::Response got = desk.api().answer(asked("anna"));
  ASSERT_TRUE(static_cast<bool>(got.later));
  EXPECT_EQ(got.takes, web::Takes::hashing);
  EXPECT_EQ(got.later({}).status, 200U);
  EXPECT_EQ(desk.api().answer(asked(std::string(10'000, 'x'))).status, 413U);
}

// Many at once would all begin before the first has failed.
TEST_F(PageApi, CountsGuessesThatCameTogether) {
  std::vector<web::Response> got;
  for (int i = 0; i < 7; ++i) {
    got.push_back(desk.api().answer(
        PageDesk::request("POST", "/api/v1/session", R"({"name":"anna","password":"guess me"})")));
    ASSERT_TRUE(static_cast<bool>(got.back().later)) << i;
  }
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].later({}).status, i < 5 ? 401U : 429U) << i;
  }
}

TEST_F(PageApi, WhatActsAtOnceTakesAConfirmationInAct) {
  log_in("anna");
  const auto is_held_back = [this](const Route& route, const char* body) {
    const auto got = desk.ask(std::string(route.method), address_of(route), body);
    return got.status == 422 &&
           Json::parse(got.body)["error"]["to_do"] == R"(send "confirm": true)";
  };
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    desk.loop().ask_mode(mode);
    for (const Route& route : Api::routes()) {
      if (route.method != "POST" || route.open || route.path == Api::kHandBack) {
        continue;
      }
      const std::string path(route.path);
      const bool acts =
          path.ends_with("modulation") || path.ends_with("measured") || path.ends_with("apply");
      EXPECT_EQ(is_held_back(route, "{}"), acts && mode == Mode::act) << path;
      EXPECT_EQ(is_held_back(route, R"({"confirm":"yes"})"), acts && mode == Mode::act) << path;
      EXPECT_FALSE(is_held_back(route, R"({"confirm":true})")) << path;
    }
  }
}

TEST_F(PageApi, ASessionEndsWithItsLogOut) {
  log_in("anna");
  auto request = PageDesk::request("GET", "/api/v1/stream");
  request.cookie = desk.cookie();
  auto stream = desk.api().admit(request);
  ASSERT_TRUE(std::holds_alternative<web::Server::Admitted>(stream));
  EXPECT_TRUE(std::get<web::Server::Admitted>(stream).goes_on());
  EXPECT_THAT(std::get<web::Server::Admitted>(stream).first, HasSubstr(R"("type":"hello")"));
  EXPECT_EQ(desk.ask("DELETE", "/api/v1/session").status, 204U);
  EXPECT_FALSE(std::get<web::Server::Admitted>(stream).goes_on());
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 401U);
}

TEST_F(PageApi, ASessionFollowsItsAccount) {
  log_in("anna");
  auto request = PageDesk::request("GET", "/api/v1/stream");
  request.cookie = desk.cookie();
  auto stream = desk.api().admit(request);
  ASSERT_TRUE(std::holds_alternative<web::Server::Admitted>(stream));
  const auto change = [this](auto with) {
    auto accounts = web::Accounts::read(file).value();
    with(accounts);
    ASSERT_TRUE(accounts.write(file));
  };
  const std::string apply = "/api/v1/machine/apply";
  EXPECT_NE(desk.ask("POST", apply, "{}").status, 403U);
  change([](web::Accounts& a) { a.remove_user("anna"); });
  EXPECT_FALSE(std::get<web::Server::Admitted>(stream).goes_on());
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 401U);
  change([](web::Accounts& a) { ASSERT_TRUE(a.set_user("anna", "a new secret", Role::viewer)); });
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 401U) << "its session has ended";
  log_in("otto");
  change(
      [](web::Accounts& a) { ASSERT_TRUE(a.set_user("otto", "a new secret", Role::operating)); });
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 401U) << "of the old password";
}

// Copies of such a value would go as deep down the stack.
TEST_F(PageApi, RefusesWhatIsNestedWithoutEnd) {
  log_in("anna");
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const Route& route : Api::routes()) {
    if (route.method == "POST") {
      const auto got = desk.ask("POST", address_of(route), R"({"mode":)" + deep + "}");
      // A log-in has a bound of its own.
      EXPECT_EQ(got.status, address_of(route) == "/api/v1/session" ? 413U : 400U) << route.path;
    }
  }
}

TEST_F(PageApi, AccountsStayAsTheyWereWhileTheirFileCannotBeRead) {
  log_in("anna");
  std::ofstream(file) << "{";
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 200U);
  EXPECT_EQ(desk.ask("DELETE", "/api/v1/session").status, 204U);
  log_in("otto");
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 200U);
  std::filesystem::remove(file);
  EXPECT_EQ(desk.ask("GET", "/api/v1/status").status, 200U);
}

TEST_F(PageApi, NamesTheMethodsOfAnAddress) {
  log_in("anna");
  const auto got = desk.ask("PUT", "/api/v1/session");
  EXPECT_EQ(got.status, 405U);
  EXPECT_THAT(got.head, Contains(Pair("Allow", "GET, POST, DELETE")));
  EXPECT_EQ(desk.ask("GET", "/api/v1/none").status, 404U);
  EXPECT_EQ(desk.ask("GET", "/none.js").status, 404U);
  EXPECT_EQ(desk.ask("POST", "/live.js").status, 404U);
  EXPECT_THAT(desk.ask("POST", "/api/v1/records/x", "{}").head, Contains(Pair("Allow", "GET")));
}

TEST_F(PageApi, CookieIsTheBrowsersAloneAndSecureOverTls) {
  auto request = PageDesk::request("POST", "/api/v1/session",
                                   R"({"name":"anna","password":"secret of anna"})");
  request.secure = true;
  const auto got = desk.answered(request);
  EXPECT_THAT(got.head,
              Contains(Pair("Set-Cookie", HasSubstr("; HttpOnly; SameSite=Strict; Secure"))));
}

TEST_F(PageApi, SessionsOfTwoPagesOnOneComputerDoNotMix) {
  auto request = PageDesk::request("POST", "/api/v1/session",
                                   R"({"name":"anna","password":"secret of anna"})");
  request.host = "127.0.0.1:8080";
  const auto got = desk.answered(request);
  const std::string own = got.head[0].second.substr(0, got.head[0].second.find(';'));
  EXPECT_THAT(own, testing::StartsWith("steadyrest_session_8080="));
  auto later = PageDesk::request("GET", "/api/v1/status");
  later.cookie = "steadyrest_session_8081=x; steadyrest_session=x; " + own;
  later.host = request.host;
  EXPECT_EQ(desk.api().answer(later).status, 200U);
  later.host = "127.0.0.1:8081";
  EXPECT_EQ(desk.api().answer(later).status, 401U);
}

TEST(PageKey, LogsInWhereThereAreNoAccounts) {
  PageDesk desk;
  desk.log_in(R"({"key":"wrong"})");
  EXPECT_TRUE(desk.cookie().empty());
  desk.log_in();
  EXPECT_EQ(desk.json("GET", "/api/v1/session")["session"]["role"], "engineer");
}

// The description and the server's own routes: the same, method by method.
TEST(OpenApi, DescribesEveryRouteWithItsRole) {
  const Json description = Json::parse(openapi().bytes);
  std::vector<std::string> described;
  for (const auto& [path, methods] : description["paths"].items()) {
    for (const auto& [method, of] : methods.items()) {
      described.push_back(method + " " + path + " " + of["x-role"].get<std::string>());
    }
  }
  std::vector<std::string> routed;
  for (const Route& route : Api::routes()) {
    std::string method(route.method);
    std::ranges::transform(method, method.begin(), ::tolower);
    const std::string role(route.open ? "none" : word(route.role));
    if (!route.path.ends_with('/')) {
      routed.push_back(method + " " + std::string(route.path) + " " + role);
      continue;
    }
    const std::string one = std::string(route.path) + "{name}";
    const std::vector<std::string> behind = route.method == "POST"
                                                ? std::vector<std::string>{"/replay"}
                                                : std::vector<std::string>{"", "/data", "/export"};
    for (const std::string& rest : behind) {
      routed.push_back(method + " " + one + rest + " " + role);
    }
  }
  EXPECT_THAT(described, testing::UnorderedElementsAreArray(routed));
}

}  // namespace
}  // namespace steadyrest::apps::live_page
