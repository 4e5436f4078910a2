// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/web/server.hpp>

namespace steadyrest::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using kernel::file::Temporary;
using std::chrono::steady_clock;

/// A server whose answers to `/slow` wait until they are let go, or told to stop.
class WithSlowAnswers : public testing::Test {
 protected:
  void open(Server::Config config = {}) {
    config.gate.hosts = {"127.0.0.1"};
    server = std::move(
        *Server::open(std::move(config),
                      {.answer = [this](const Request& request) { return answer(request); },
                       .admit = [](const Request&) -> std::variant<Server::Admitted, Response> {
                         return error(404, "not_found", "no", "no");
                       },
                       .now_s = [] { return 0.0; }}));
    port = server->port();
  }

  Response answer(const Request& request) {
    Response out;
    out.body = "quick";
    if (request.path == "/slow" || request.path == "/slowest") {
      out.takes = request.path == "/slowest" ? Takes::minutes : Takes::seconds;
      out.later = [this](const std::stop_token& stop) {
        begun.fetch_add(1);
        until([&] { return let_go.load() || stop.stop_requested(); });
        Response late;
        late.body = "late";
        return late;
      };
    } else if (request.path == "/file") {
      out.file = file;
      out.keeper = std::make_shared<const Temporary>(file, Temporary::Kind::file);
    }
    return out;
  }

  struct Got {
    unsigned status = 0;
    std::string body;
  };
  /// Nothing is read before `reads_after`.
  [[nodiscard]] Got got(const std::string& path, http::verb verb = http::verb::get,
                        steady_clock::duration reads_after = {}) const {
    asio::io_context io;
    tcp::socket socket(io);
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    http::request<http::empty_body> request(verb, path, 11);
    request.set(http::field::host, "127.0.0.1");
    beast::error_code fault;
    http::write(socket, request, fault);
    const auto begin = steady_clock::now();
    until([&] { return steady_clock::now() - begin >= reads_after; });
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> answer;
    answer.body_limit(1U << 30U);
    answer.skip(verb == http::verb::head);
    http::read(socket, buffer, answer, fault);
    return {fault ? 0 : answer.get().result_int(), answer.get().body()};
  }
  [[nodiscard]] std::future<Got> asked_for(const std::string& path) const {
    return std::async(std::launch::async, [this, path] { return got(path); });
  }
  template <class Done>
  static void until(const Done& done) {
    while (!done()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  kernel::file::testing::OwnFolder folder;
  std::string file = folder.at("file");
  std::atomic<int> begun{0};
  std::atomic<bool> let_go{false};
  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

TEST_F(WithSlowAnswers, DelayNoQuickOne) {
  open();
  auto first = asked_for("/slow");
  auto second = asked_for("/slow");
  until([this] { return begun.load() == 2; });
  auto third = asked_for("/slow");  // it waits for one of these
  EXPECT_EQ(got("/quick").body, "quick");
  EXPECT_EQ(begun.load(), 2);
  let_go.store(true);
  for (auto* const slow : {&first, &second, &third}) {
    EXPECT_EQ(slow->get().body, "late");
  }
}

TEST_F(WithSlowAnswers, WaitForNoneThatTakesMinutes) {
  open();
  auto first = asked_for("/slowest");
  auto second = asked_for("/slowest");
  until([this] { return begun.load() == 2; });
  auto slow = asked_for("/slow");
  until([this] { return begun.load() == 3; });
  let_go.store(true);
  EXPECT_EQ(slow.get().body, "late");
}

TEST_F(WithSlowAnswers, AreRefusedWhereThereAreTooMany) {
  open({.most_slow = 1});
  auto first = asked_for("/slow");
  until([this] { return begun.load() == 1; });
  const Got more = got("/slow");
  EXPECT_EQ(more.status, 503U);
  EXPECT_THAT(more.body, testing::HasSubstr("\"busy\""));
  let_go.store(true);
  EXPECT_EQ(first.get().body, "late");
  EXPECT_EQ(got("/slow").body, "late");
}

TEST_F(WithSlowAnswers, GiveUpWhenTheServerEnds) {
  open();
  std::vector<std::future<Got>> all;
  for (int i = 0; i < 4; ++i) {
    all.push_back(asked_for("/slow"));
  }
  until([this] { return begun.load() == 2; });
  server.reset();
  EXPECT_EQ(begun.load(), 2) << "those that waited are dropped";
}

TEST_F(WithSlowAnswers, AFileIsSentWholeToAClientThatTakesItsTimeAndIsGoneThen) {
  const std::string contents(64U << 20U, 'x');  // more than the sockets' buffers hold
  std::ofstream(file) << contents;
  open({.patience_s = 2.0, .slowest_bytes_s = 1e6});
  const Got whole = got("/file", http::verb::get, std::chrono::seconds(3));
  EXPECT_EQ(whole.status, 200U);
  EXPECT_TRUE(whole.body == contents);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(WithSlowAnswers, AFileIsNotSentToWhoAsksForTheHeadAlone) {
  std::ofstream(file) << "contents";
  open();
  EXPECT_EQ(got("/file", http::verb::head).status, 200U);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace steadyrest::web
