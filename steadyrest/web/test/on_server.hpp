// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <gtest/gtest.h>

#include <steadyrest/web/server.hpp>

namespace steadyrest::web::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;

inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A server that answers with what it was asked, and streams to whoever has the right cookie.
class OnServer : public testing::Test {
 protected:
  std::unique_ptr<Server> open(Server::Config config = {}) {
    config.gate.hosts = {"127.0.0.1"};
    config.gate.urgent_path = "/hand-back";
    config.stream_path = "/stream";
    auto server = Server::open(
        std::move(config),
        {.answer =
             [this](const Request& request) {
               asked.fetch_add(1);
               Response out;
               out.body = request.method + " " + request.path + " " + request.body + " of " +
                          request.address;
               if (request.path == "/large") {
                 out.body.assign(std::size_t{4} << 20U, 'x');
               }
               if (request.path == "/blocks") {
                 until([this] { return answers.load(); });
               }
               if (request.path == "/hashes") {
                 out.takes = Takes::hashing;
               }
               if (request.path == "/waits" || request.path == "/hashes") {
                 out.later = [this](const std::stop_token& stop) {
                   until([&] { return answers.load() || stop.stop_requested(); });
                   return Response{};
                 };
               }
               return out;
             },
         .admit = [this](const Request& request) -> std::variant<Server::Admitted, Response> {
           if (request.cookie != "in") {
             return error(401, "not_logged_in", "no", "no");
           }
           return Server::Admitted{.first = "hello", .goes_on = [this] { return goes_on.load(); }};
         },
         .now_s = now_s});
    EXPECT_TRUE(server.has_value());
    return std::move(*server);
  }

  /// From any address of this computer.
  static tcp::socket connected(asio::io_context& io, const Server& server,
                               const std::string& from = "127.0.0.1") {
    tcp::socket socket(io, tcp::endpoint(asio::ip::make_address(from), 0));
    socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
    return socket;
  }

  /// Everything that comes back for these bytes.
  static std::string said(const Server& server, const std::string& bytes,
                          const std::string& from = "127.0.0.1") {
    asio::io_context io;
    tcp::socket socket = connected(io, server, from);
    beast::error_code fault;
    asio::write(socket, asio::buffer(bytes), fault);
    std::string out;
    asio::read(socket, asio::dynamic_buffer(out), fault);
    return out;
  }

  static std::string request(const std::string& line, const std::string& head = {},
                             const std::string& body = {}) {
    return line + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" + head +
           (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") +
           "\r\n" + body;
  }

  using Socket = websocket::stream<tcp::socket>;
  static beast::error_code shake(Socket& socket, const std::string& cookie,
                                 const std::string& origin = {}) {
    socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& head) {
      head.set(http::field::cookie, cookie);
      if (!origin.empty()) {
        head.set(http::field::origin, origin);
      }
    }));
    beast::error_code fault;
    socket.handshake("127.0.0.1", "/stream", fault);
    return fault;
  }
  static std::string next(Socket& socket) {
    beast::flat_buffer buffer;
    beast::error_code fault;
    socket.read(buffer, fault);
    return fault ? "closed" : beast::buffers_to_string(buffer.data());
  }
  static void until(const std::function<bool()>& done) {
    while (!done()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::atomic<int> asked{0};
  std::atomic<bool> goes_on{true};
  std::atomic<bool> answers{false};  ///< to /waits
};

}  // namespace steadyrest::web::test
