// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/web/server.hpp>
#include <steadyrest/web/test/on_server.hpp>

// What one client does must not keep the others out, and nobody may delay a hand-back. How long
// that takes under floods is measured by bench/live/page_floods.py.
namespace steadyrest::web {
namespace {

using test::OnServer;
using test::asio::ip::tcp;
using testing::HasSubstr;
using testing::StartsWith;
namespace asio = test::asio;
namespace beast = test::beast;

class Flooded : public OnServer {
 protected:
  /// A client that asks and reads nothing.
  void hog(const Server& server, const std::string& text, const std::string& from) {
    held.push_back(connected(io, server, from));
    beast::error_code fault;
    asio::write(held.back(), asio::buffer(text), fault);
  }
  /// Whoever asks again where all connections were being answered at that moment, as they are told.
  static std::string served(const Server& server, const std::string& from) {
    std::string got;
    until([&] { return (got = said(server, request("GET /a"), from)).find(" 503 ") == got.npos; });
    return got;
  }
  static std::string hand_back(const Server& server) {
    return said(server, request("POST /hand-back"));
  }
  asio::io_context io;
  std::vector<tcp::socket> held;
};

const std::string kLarge = "GET /large HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";

TEST_F(Flooded, ByOneThatAsksAndNeverReadsOthersAreServed) {
  Server::Config config;
  config.most_connections = 8;
  const auto server = open(config);
  for (int i = 0; i < 40; ++i) {
    hog(*server, kLarge + kLarge, "127.0.0.2");
    if (i % 8 == 7) {
      EXPECT_THAT(served(*server, "127.0.0.1"), HasSubstr(" 200 ")) << i;
      EXPECT_THAT(served(*server, "127.0.0.2"), HasSubstr(" 200 ")) << i;
      EXPECT_THAT(hand_back(*server), HasSubstr(" 200 ")) << i;
    }
  }
  EXPECT_THAT(hand_back(*server), HasSubstr(" 200 "));
}

TEST_F(Flooded, FromManyAddressesOthersAreServed) {
  Server::Config config;
  config.most_connections = 8;
  config.gate.rate.most_keys = 16;
  const auto server = open(config);
  for (int i = 1; i < 200; ++i) {
    const std::string from = "127.1.0." + std::to_string(i);
    hog(*server, i % 3 == 0 ? kLarge : i % 3 == 1 ? "POST /a HTTP/1.1\r\nHost: 127" : "", from);
    if (i % 20 == 0) {
      EXPECT_THAT(served(*server, "127.0.0.1"), HasSubstr(" 200 ")) << i;
      EXPECT_THAT(hand_back(*server), HasSubstr(" 200 ")) << i;
    }
  }
}

// Each with its request, as fast as they can be made.
TEST_F(Flooded, WithConnectionsAHandBackOfTheSameAddressIsAnswered) {
  const auto server = open();
  int closed = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string got = said(*server, request("GET /a"));
    closed += got.find(" 200 ") == std::string::npos ? 1 : 0;
    if (i % 100 == 99) {
      EXPECT_THAT(hand_back(*server), HasSubstr(" 200 ")) << i;
      EXPECT_THAT(said(*server, request("GET /a"), "127.0.0.3"), HasSubstr(" 200 ")) << i;
    }
  }
  EXPECT_LT(closed, 2000);
}

TEST_F(Flooded, WhoeverTakesNothingIsCutOff) {
  Server::Config config;
  config.patience_s = 0.2;
  config.slowest_bytes_s = 1e8;  // what the sockets hold counts as taken
  const auto server = open(config);
  hog(*server, kLarge, "127.0.0.2");
  until([this] { return asked == 1; });
  until([this] {
    // Reading would give it time; the peer's end shows in the socket's state.
    beast::error_code fault;
    held.front().write_some(asio::buffer("GET", 3), fault);
    return static_cast<bool>(fault);
  });
}

// 4 MB at 1 MB/s and 0.2 s.
TEST_F(Flooded, WhoeverTakesItSlowlyHasTime) {
  Server::Config config;
  config.patience_s = 5.0;
  config.slowest_bytes_s = 1e6;
  const auto server = open(config);
  hog(*server, request("GET /large"), "127.0.0.2");
  std::string got;
  beast::error_code fault;
  std::array<char, 1 << 18> part{};
  while (!fault) {
    got.append(part.data(), held.front().read_some(asio::buffer(part), fault));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(got.size(), std::size_t{4} << 20U);
}

TEST_F(Flooded, AHandBackComesBeforeAllThatWait) {
  const auto server = open();
  hog(*server, request("GET /blocks"), "127.0.0.2");
  until([this] { return asked == 1; });
  for (int i = 0; i < 20; ++i) {
    hog(*server, request("GET /a"), "127.0.0.3");
  }
  // Each is in the queue once the next request of another connection has been refused by the gate.
  EXPECT_THAT(said(*server, "GET / HTTP/1.1\r\nHost: evil\r\nConnection: close\r\n\r\n"),
              HasSubstr(" 421 "));
  auto first = std::async(std::launch::async, [&] { return hand_back(*server); });
  EXPECT_THAT(said(*server, "GET / HTTP/1.1\r\nHost: evil\r\nConnection: close\r\n\r\n"),
              HasSubstr(" 421 "));
  answers = true;
  EXPECT_THAT(first.get(), HasSubstr(" 200 "));
}

// As a log-in is: a 429 or 503 is what floods get, and one client never takes the whole queue.
TEST_F(Flooded, PasswordsAreHashedBesideOtherAnswers) {
  const auto server = open();
  for (int i = 0; i < 3; ++i) {
    hog(*server, request("GET /hashes"), "127.0.0.2");
  }
  until([this] { return asked == 3; });
  std::string third;
  beast::error_code fault;
  asio::read(held[2], asio::dynamic_buffer(third), fault);
  EXPECT_THAT(third, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(third, HasSubstr("Retry-After"));
  EXPECT_THAT(hand_back(*server), HasSubstr(" 200 "));
  EXPECT_THAT(said(*server, request("GET /a"), "127.0.0.2"), HasSubstr(" 200 "));
  auto other =
      std::async(std::launch::async, [&] { return said(*server, request("GET /hashes")); });
  until([this] { return asked == 6; });
  answers = true;
  EXPECT_THAT(other.get(), HasSubstr(" 200 "));
}

TEST_F(Flooded, StreamsOfOneAddressLeaveRoomForOthers) {
  Server::Config config;
  config.most_streams = 3;
  const auto server = open(config);
  std::vector<std::unique_ptr<Socket>> hogs;
  for (int i = 0; i < 3; ++i) {
    hogs.push_back(std::make_unique<Socket>(connected(io, *server, "127.0.0.2")));
    ASSERT_FALSE(shake(*hogs.back(), "in"));
    EXPECT_EQ(next(*hogs.back()), "hello");
  }
  Socket more(connected(io, *server, "127.0.0.2"));
  EXPECT_TRUE(shake(more, "in")) << "it has its share";
  Socket other(connected(io, *server));
  ASSERT_FALSE(shake(other, "in"));
  EXPECT_EQ(next(other), "hello");
  EXPECT_EQ(next(*hogs[0]), "closed");
  Socket third(connected(io, *server, "127.0.0.3"));
  ASSERT_FALSE(shake(third, "in"));
  EXPECT_EQ(next(*hogs[1]), "closed");
  Socket fourth(connected(io, *server, "127.0.0.4"));
  EXPECT_TRUE(shake(fourth, "in")) << "all have as much";
}

TEST_F(Flooded, AStreamThatIsNotReadEnds) {
  Server::Config config;
  config.patience_s = 0.2;
  const auto server = open(config);
  Socket hog(connected(io, *server));
  ASSERT_FALSE(shake(hog, "in"));
  EXPECT_EQ(next(hog), "hello");
  EXPECT_EQ(server->streams(), 1U);
  const auto large =
      std::make_shared<const std::string>("\"x\":\"" + std::string(1 << 24, 'x') + "\"}");
  server->publish(large);
  until([&] { return server->streams() == 0; });
}

// A proxy in front may see the body end elsewhere, and another request in what is left.
TEST_F(Flooded, ABodyHasOneEndOrIsRefused) {
  const auto server = open();
  const std::string hidden = request("POST /hidden");
  const std::string length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n";
  struct Case {
    std::string headers;
    const char* status;
  };
  for (const Case& at : {Case{"Transfer-Encoding: xchunked\r\n", "501"},
                         Case{"Transfer-Encoding: identity\r\n", "501"},
                         Case{"Transfer-Encoding: xchunked\r\n" + length, "400"},
                         Case{length + "Transfer-Encoding: xchunked\r\n", "400"},
                         Case{"Transfer-Encoding: identity\r\n" + length, "400"},
                         Case{length + "Transfer-Encoding: chunked\r\n", "400"},
                         Case{"Transfer-Encoding: identity, chunked\r\n", ""},
                         Case{"Transfer-Encoding: gzip, chunked\r\n", ""},
                         Case{"Transfer-Encoding: chunked, gzip\r\n", ""},
                         Case{"Transfer-Encoding: chunked, chunked\r\n", ""},
                         Case{"Transfer-Encoding: gzip\r\nTransfer-Encoding: chunked\r\n", ""},
                         Case{"Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n", ""},
                         Case{"Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n", ""},
                         Case{"Transfer-Encoding:\r\n", ""},
                         Case{"Transfer-Encoding: \"chunked\"\r\n", ""},
                         Case{"Transfer-Encoding: chunked;q=1\r\n", ""},
                         Case{"Content-Length: 1, 1\r\n", ""},
                         Case{"Content-Length: +1\r\n", ""},
                         Case{"Content-Length: -1\r\n", ""},
                         Case{"Content-Length: 0x10\r\n", ""},
                         Case{"Content-Length: 99999999999999999999\r\n", ""}}) {
    const std::string got = said(
        *server, "POST /a HTTP/1.1\r\nHost: 127.0.0.1\r\n" + at.headers + "\r\n0\r\n\r\n" + hidden);
    EXPECT_THAT(got, testing::AnyOf(StartsWith("HTTP/1.1 400"), StartsWith("HTTP/1.1 501"),
                                    StartsWith("HTTP/1.1 413")))
        << at.headers;
    EXPECT_THAT(got, HasSubstr(at.status)) << at.headers;
    EXPECT_EQ(got.find("HTTP/1.1 ", 8), std::string::npos) << "one answer: " << at.headers << got;
  }
  EXPECT_EQ(asked.load(), 0);
  EXPECT_THAT(said(*server,
                   "POST /a HTTP/1.0\r\nHost: 127.0.0.1\r\nTransfer-Encoding: "
                   "chunked\r\n\r\n4\r\nbody\r\n0\r\n\r\n"),
              StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(said(*server,
                   "POST /a HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: "
                   "close\r\nTransfer-Encoding: Chunked\r\n\r\n4\r\nbody\r\n0\r\n\r\n"),
              HasSubstr("POST /a body"));
}

}  // namespace
}  // namespace steadyrest::web
