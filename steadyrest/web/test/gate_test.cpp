// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/message.hpp>

namespace steadyrest::web {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

unsigned status_of(Gate& gate, const Request& request, bool writes) {
  const auto refused = gate.refuse(request, writes, 0.0);
  return refused ? refused->status : 200;
}

Request from(const std::string& host, const std::string& origin = {}) {
  Request request;
  request.host = host;
  request.origin = origin;
  return request;
}

TEST(Gate, KnowsItsOwnNames) {
  Gate gate({.hosts = {"127.0.0.1", "localhost", "[::1]"}});
  for (const char* const own :
       {"127.0.0.1:8080", "localhost", "LOCALHOST:1", "[::1]:8080", "[::1]"}) {
    EXPECT_EQ(status_of(gate, from(own), false), 200U) << own;
  }
  for (const char* const other : {"", "evil.example", "127.0.0.1.evil.example", "localhost.:80"}) {
    EXPECT_EQ(status_of(gate, from(other), false), 421U) << other;
  }
}

TEST(Gate, OnAllAddressesIsAskedByAnyNumberButByNoOtherName) {
  Gate gate({.hosts = {"localhost"}, .any_number = true});
  for (const char* const own : {"192.168.1.7:8443", "10.0.0.1", "[fe80::1]:80", "localhost"}) {
    EXPECT_EQ(status_of(gate, from(own), false), 200U) << own;
  }
  for (const char* const other :
       {"mill.example", "192.168.1.7.evil.example", "[::1", "1.2.3", ""}) {
    EXPECT_EQ(status_of(gate, from(other), false), 421U) << other;
  }
}

TEST(Gate, LetsOnlyItsOwnPagesWrite) {
  Gate gate({.hosts = {"localhost"}, .outer_origin = "https://mill.example"});
  EXPECT_EQ(status_of(gate, from("localhost:80", "http://localhost:80"), true), 200U);
  EXPECT_EQ(status_of(gate, from("localhost:80"), true), 200U) << "a script";
  EXPECT_EQ(status_of(gate, from("localhost:80", "https://mill.example"), true), 200U);
  for (const char* const other :
       {"http://localhost:81", "https://localhost:80", "null", "http://evil.example"}) {
    EXPECT_EQ(status_of(gate, from("localhost:80", other), true), 403U) << other;
  }
}

TEST(Gate, RefusesTooManyOfOneAddress) {
  Gate gate({.hosts = {"localhost"}, .rate = {.per_s = 0.5, .burst = 2.0}});
  EXPECT_EQ(status_of(gate, from("localhost"), false), 200U);
  EXPECT_EQ(status_of(gate, from("localhost"), false), 200U);
  const auto refused = gate.refuse(from("localhost"), false, 0.0);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->status, 429U);
  EXPECT_THAT(refused->head, Contains(Pair("Retry-After", "2")));
}

TEST(Gate, CountsTheUrgentPathApart) {
  Gate gate(
      {.hosts = {"localhost"}, .urgent_path = "/hand-back", .rate = {.per_s = 0.5, .burst = 1.0}});
  Request urgent = from("localhost");
  urgent.path = "/hand-back";
  EXPECT_EQ(status_of(gate, from("localhost"), false), 200U);
  EXPECT_EQ(status_of(gate, from("localhost"), false), 429U);
  EXPECT_EQ(status_of(gate, urgent, true), 200U);
  EXPECT_EQ(status_of(gate, urgent, true), 429U);
}

TEST(ClientAddress, IsTheOneThatANamedProxySees) {
  const Gate::Config alone;
  const Gate::Config behind{.outer_origin = "https://mill.example"};
  EXPECT_EQ(client_address(alone, "127.0.0.1", "10.0.0.7"), "127.0.0.1");
  EXPECT_EQ(client_address(behind, "127.0.0.1", ""), "127.0.0.1");
  EXPECT_EQ(client_address(behind, "127.0.0.1", "10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(client_address(behind, "127.0.0.1", "1.2.3.4, fe80::7"), "fe80::7")
      << "the client can put anything before it";
  EXPECT_EQ(client_address(behind, "127.0.0.1", "10.0.0.7, unknown"), "127.0.0.1");
}

TEST(Target, ComesInItsParts) {
  Request request;
  ASSERT_TRUE(parse_target("/api/v1/records/run%20a?from_s=1&search=%C3%A4&empty", request));
  EXPECT_EQ(request.path, "/api/v1/records/run a");
  EXPECT_EQ(request.query["from_s"], "1");
  EXPECT_EQ(request.query["search"], "ä");
  EXPECT_TRUE(request.query.contains("empty"));
}

TEST(Target, ThatCannotBeOneIsNone) {
  for (const char* const wrong :
       {"", "api", "/../x", "/a/..", "/a/%2e%2e/x", "/a/%2E%2E", "/%", "/%4", "/%zz", "/a%00b",
        "/a%0d%0ab", "/a\\b", "//a", "/x?a=%", "http://evil.example/"}) {
    Request request;
    EXPECT_FALSE(parse_target(wrong, request)) << wrong;
  }
}

TEST(MediaType, HasNoParametersAndNoCase) {
  for (const char* const same : {"application/json", "Application/JSON; charset=utf-8",
                                 "application/json;charset=utf-8", " application/json\t; x"}) {
    EXPECT_EQ(media_type(same), "application/json") << same;
  }
  for (const char* const other : {"", ";", " ", "text/plain; application/json"}) {
    EXPECT_NE(media_type(other), "application/json") << other;
  }
}

TEST(Cookie, IsFoundAmongOthers) {
  Request request;
  request.cookie = "a=1; steadyrest_session=xyz; steadyrest=2";
  EXPECT_EQ(cookie(request, "steadyrest_session"), "xyz");
  EXPECT_EQ(cookie(request, "steadyrest"), "2");
  EXPECT_EQ(cookie(request, "session"), "");
}

TEST(SecurityHeads, AreOnEveryAnswer) {
  Response response = error(404, "not_found", "no \"such\" thing", "look elsewhere");
  EXPECT_THAT(response.body, HasSubstr(R"("what":"no \"such\" thing")"));
  add_security_heads(response, true);
  EXPECT_THAT(response.head,
              Contains(Pair("Content-Security-Policy", HasSubstr("default-src 'none'"))));
  EXPECT_THAT(response.head, Contains(Pair("Cache-Control", "no-store")));
  EXPECT_THAT(response.head, Contains(Pair("Strict-Transport-Security", HasSubstr("max-age"))));
}

TEST(AProxy, IsBelievedAndLetInByItsAddress) {
  const Gate::Config none;
  EXPECT_TRUE(may_connect(none, "10.0.0.9")) << "there is no proxy";
  const Gate::Config any = {.outer_origin = "https://mill.example"};
  EXPECT_TRUE(may_connect(any, "127.0.0.1"));
  const Gate::Config named = {.outer_origin = "https://mill.example", .proxies = {"10.0.0.7"}};
  EXPECT_TRUE(may_connect(named, "10.0.0.7"));
  EXPECT_TRUE(may_connect(named, "127.0.0.1")) << "a script of this computer";
  EXPECT_FALSE(may_connect(named, "10.0.0.9"));
  EXPECT_EQ(client_address(named, "10.0.0.7", "192.168.1.7"), "192.168.1.7");
  EXPECT_EQ(client_address(named, "127.0.0.1", "192.168.1.7"), "127.0.0.1") << "it may be forged";
}

}  // namespace
}  // namespace steadyrest::web
