// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/web/server.hpp>
#include <steadyrest/web/test/on_server.hpp>

namespace steadyrest::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using test::OnServer;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(OnServer, AnswersWithTheHeadsThatKeepOthersOut) {
  const auto server = open();
  const std::string got = said(*server, request("POST /a?b=c", {}, "body"));
  EXPECT_THAT(got, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(got, HasSubstr("POST /a body"));
  EXPECT_THAT(got, HasSubstr("frame-ancestors 'none'"));
}

TEST_F(OnServer, RefusesWhatIsWrongBeforeAnybodyIsAsked) {
  Server::Config config;
  config.most_body = 100;
  config.most_head = 1000;
  const auto server = open(config);
  EXPECT_THAT(said(*server, request("POST /a", {}, std::string(101, 'x'))), HasSubstr(" 413 "));
  EXPECT_THAT(said(*server, request("GET /a", "X-Long: " + std::string(2000, 'x') + "\r\n")),
              HasSubstr(" 431 "));
  EXPECT_THAT(said(*server, request("GET /../etc/passwd")), HasSubstr(" 400 "));
  EXPECT_THAT(said(*server, "rubbish\r\n\r\n"), HasSubstr(" 400 "));
  EXPECT_THAT(said(*server, "GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"),
              HasSubstr(" 421 "));
  EXPECT_THAT(said(*server, request("POST /a", "Origin: http://evil.example\r\n", "x")),
              HasSubstr(" 403 "));
  EXPECT_EQ(asked.load(), 0);
  EXPECT_THAT(said(*server, request("GET /")), HasSubstr(" 200 "));
}

// A proxy in front may go by one of them, the server by the other.
TEST_F(OnServer, RefusesAHeadThatComesTwice) {
  const auto server = open();
  for (const std::string name :
       {"Host", "Origin", "Authorization", "Content-Type", "Content-Length"}) {
    const std::string value = name == "Content-Length" ? ": 0\r\n" : ": 127.0.0.1\r\n";
    const std::string heads = name + value + name + value;
    const std::string got = said(*server, request("GET /", heads));
    EXPECT_THAT(got, StartsWith("HTTP/1.1 400")) << name;
    EXPECT_THAT(got, HasSubstr("the head " + name + " was sent ")) << name;
  }
  EXPECT_EQ(asked.load(), 0);
}

TEST_F(OnServer, AnswersAHeadRequestWithTheLengthAlone) {
  const auto server = open();
  const std::string got = said(*server, request("HEAD /a"));
  const std::string body = "HEAD /a  of 127.0.0.1";
  EXPECT_THAT(got, HasSubstr("Content-Length: " + std::to_string(body.size()) + "\r\n"));
  EXPECT_TRUE(got.ends_with("\r\n\r\n")) << got;
}

TEST_F(OnServer, GoesByTheAddressThatTheProxyHasAdded) {
  Server::Config config;
  config.gate.outer_origin = "https://mill.example";
  const auto server = open(config);
  const std::string forged = "X-Forwarded-For: 1.2.3.4\r\n";
  EXPECT_THAT(said(*server, request("GET /", forged + "X-Forwarded-For: 10.0.0.7\r\n")),
              HasSubstr(" of 10.0.0.7"));
}

TEST_F(OnServer, CutsOffWhoeverIsTooSlow) {
  Server::Config config;
  config.patience_s = 0.2;
  const auto server = open(config);
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(said(*server, "GET / HTTP/1.1\r\nHost: 127"), "");
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(190));
  std::string got;
  for (int i = 0; i < 300 && got.empty(); ++i) {  // on a busy computer this one is slow too
    got = said(*server, request("GET /"));
  }
  EXPECT_THAT(got, HasSubstr(" 200 "));
}

TEST_F(OnServer, WhoOnlyHoldsConnectionsKeepsNobodyOut) {
  Server::Config config;
  config.most_connections = 2;
  const auto server = open(config);
  asio::io_context io;
  std::vector<tcp::socket> held;
  for (int i = 0; i < 20; ++i) {
    held.push_back(connected(io, *server));
  }
  EXPECT_THAT(said(*server, request("GET /")), HasSubstr(" 200 "));
  beast::error_code fault;
  std::array<char, 1> byte{};
  held.front().read_some(asio::buffer(byte), fault);
  EXPECT_TRUE(fault) << "the first has given way";
}

// Those that are being answered stay; the places that are kept beside them are for urgent requests.
TEST_F(OnServer, TakesNoMoreConnectionsThanItMay) {
  Server::Config config;
  config.most_connections = 2;
  const auto server = open(config);
  asio::io_context io;
  std::vector<tcp::socket> held;
  for (int i = 0; i < 2; ++i) {
    held.push_back(connected(io, *server));
    asio::write(held.back(), asio::buffer(request("GET /waits")));
  }
  until([&] { return asked == 2; });
  EXPECT_THAT(said(*server, request("GET /")), HasSubstr(" 503 "));
  EXPECT_THAT(said(*server, request("POST /hand-back")), HasSubstr(" 200 "));
  answers = true;
  for (tcp::socket& socket : held) {
    beast::error_code fault;
    std::string out;
    asio::read(socket, asio::dynamic_buffer(out), fault);
    EXPECT_THAT(out, HasSubstr(" 200 "));
  }
}

TEST_F(OnServer, StreamsToThoseWhoAreAdmitted) {
  const auto server = open();
  asio::io_context io;
  Socket in(connected(io, *server));
  ASSERT_FALSE(shake(in, "in"));
  EXPECT_EQ(next(in), "hello");
  server->publish(std::make_shared<const std::string>("\"n\":1}"));
  EXPECT_EQ(next(in), R"({"missed":0,"n":1})");
  server->announce(std::make_shared<const std::string>("news"));
  EXPECT_EQ(next(in), "news");
  Socket out(connected(io, *server));
  EXPECT_TRUE(shake(out, "out"));
  Socket foreign(connected(io, *server));
  EXPECT_TRUE(shake(foreign, "in", "http://evil.example"));
  EXPECT_EQ(server->streams(), 1U);
}

TEST_F(OnServer, EndsAStreamThatMayNotGoOnOrThatSpeaks) {
  const auto server = open();
  asio::io_context io;
  Socket talker(connected(io, *server));
  ASSERT_FALSE(shake(talker, "in"));
  EXPECT_EQ(next(talker), "hello");
  talker.write(asio::buffer(std::string("{")));
  EXPECT_EQ(next(talker), "closed");
  Socket flood(connected(io, *server));
  ASSERT_FALSE(shake(flood, "in"));
  EXPECT_EQ(next(flood), "hello");
  beast::error_code fault;
  flood.write(asio::buffer(std::string(1 << 20, 'x')), fault);
  EXPECT_EQ(next(flood), "closed");
  Socket watcher(connected(io, *server));
  ASSERT_FALSE(shake(watcher, "in"));
  EXPECT_EQ(next(watcher), "hello");
  goes_on.store(false);
  EXPECT_EQ(next(watcher), "closed");
  until([&] { return server->streams() == 0; });
}

TEST_F(OnServer, TellsASlowClientWhatItHasMissed) {
  const auto server = open();
  asio::io_context io;
  Socket slow(connected(io, *server));
  ASSERT_FALSE(shake(slow, "in"));
  EXPECT_EQ(next(slow), "hello");
  Socket quick(connected(io, *server));
  ASSERT_FALSE(shake(quick, "in"));
  EXPECT_EQ(next(quick), "hello");
  // More than the system holds for a client that does not read.
  const std::string filler(1 << 20, 'x');
  constexpr int kSent = 64;
  for (int n = 0; n < kSent; ++n) {
    server->publish(std::make_shared<const std::string>("\"n\":" + std::to_string(n) + ",\"x\":\"" +
                                                        filler + "\"}"));
    EXPECT_THAT(next(quick), StartsWith("{\"missed\":0,\"n\":" + std::to_string(n) + ","));
  }
  int missed = 0;
  int got = 0;
  for (std::string line; !line.contains("\"n\":" + std::to_string(kSent - 1) + ",");) {
    line = next(slow);
    ASSERT_NE(line, "closed");
    missed += std::stoi(line.substr(line.find(':') + 1));
    ++got;
  }
  EXPECT_GT(missed, 0);
  EXPECT_EQ(missed + got, kSent);
}

TEST_F(OnServer, IsRefusedWhatItCannotHave) {
  const auto server = open();
  Server::Config config;
  config.port = server->port();
  EXPECT_FALSE(Server::open(config, {}).has_value());
  config.address = "nowhere";
  EXPECT_FALSE(Server::open(config, {}).has_value());
  config = {};
  config.certificate = "/none.pem";
  EXPECT_FALSE(Server::open(config, {}).has_value());
}

}  // namespace
}  // namespace steadyrest::web
