// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <list>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <fmt/core.h>

#include <steadyrest/web/stream_client.hpp>
#include <steadyrest/web/traffic.hpp>

namespace steadyrest::web {

using PlainTransport = beast::tcp_stream;
using TlsTransport = beast::ssl_stream<beast::tcp_stream>;

/// One client's requests, each answered before the next is read.
template <class Transport>
class Connection final : public Waiting,
                         public std::enable_shared_from_this<Connection<Transport>> {
 public:
  static constexpr bool kSecure = std::is_same_v<Transport, TlsTransport>;

  Connection(Traffic& traffic, Transport transport, std::string address)
      : traffic_(traffic), transport_(std::move(transport)), address_(std::move(address)) {
    ++traffic_.connections;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() override {
    goes_on();
    --traffic_.connections;
  }

  void give_way() override {
    goes_on();
    beast::get_lowest_layer(transport_).close();
  }

  void begin() {
    if constexpr (kSecure) {
      be_patient();
      wait();
      transport_.async_handshake(asio::ssl::stream_base::server,
                                 [self = this->shared_from_this()](beast::error_code fault) {
                                   self->goes_on();
                                   if (!fault) {
                                     self->read();
                                   }
                                 });
    } else {
      read();
    }
  }

 private:
  using Parser = http::request_parser<http::string_body>;
  static constexpr unsigned kNoContent = 204;

  /// The whole of what follows, not each of its bytes, must come within this time.
  void be_patient(std::uint64_t bytes = 0) {
    const double s =
        traffic_.config.patience_s + static_cast<double>(bytes) / traffic_.config.slowest_bytes_s;
    beast::get_lowest_layer(transport_)
        .expires_after(std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * s)));
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(traffic_.config.most_head));
    parser_->body_limit(traffic_.config.most_body);
    be_patient();
    wait();
    http::async_read(transport_, buffer_, *parser_,
                     [self = this->shared_from_this()](beast::error_code fault, std::size_t) {
                       self->got(fault);
                     });
  }

  void wait() { place_ = traffic_.waiting.insert(traffic_.waiting.end(), this); }
  void goes_on() {
    if (place_) {
      traffic_.waiting.erase(*std::exchange(place_, std::nullopt));
    }
  }

  void got(beast::error_code fault) {
    goes_on();
    if (fault) {
      unreadable(fault);
      return;
    }
    if (auto refused = repeated()) {
      last_ = true;
      write(std::move(*refused));
      return;
    }
    Request request;
    if (!fill(request)) {
      last_ = true;
      write(error(400, "bad_request", "the address cannot be read", "see the API's description"));
      return;
    }
    const bool stream = websocket::is_upgrade(parser_->get());
    const bool writes = stream || (request.method != "GET" && request.method != "HEAD");
    if (auto refused = traffic_.gate.refuse(request, writes, traffic_.handlers.now_s()); refused) {
      write(std::move(*refused));
      return;
    }
    asio::post(traffic_.answers,
               [self = this->shared_from_this(), stream, request = std::move(request)]() mutable {
                 self->answer(request, stream);
                 leave(std::move(self));
               });
  }

  void unreadable(beast::error_code fault) {
    last_ = true;
    if (fault == http::error::body_limit) {
      write(error(413, "too_large", "the body is too large", at_most(traffic_.config.most_body)));
    } else if (fault == http::error::header_limit) {
      write(error(431, "too_large", "the head is too large", at_most(traffic_.config.most_head)));
    } else if (fault.category() == http::make_error_code(http::error::bad_method).category() &&
               fault != http::error::end_of_stream && fault != http::error::partial_message) {
      write(error(400, "bad_request", "this is not an HTTP request", "speak HTTP/1.1"));
    } else {
      close();
    }
  }

  static std::string at_most(std::size_t bytes) {
    return fmt::format("send at most {} bytes", bytes);
  }

  /// A proxy in front might go by the other one.
  [[nodiscard]] std::optional<Response> repeated() const {
    constexpr std::array kOnce = {http::field::host, http::field::origin,
                                  http::field::authorization, http::field::content_type};
    for (const http::field name : kOnce) {
      if (const std::size_t count = parser_->get().count(name); count > 1) {
        return error(400, "bad_request",
                     fmt::format("the head {} was sent {} times; allowed: once",
                                 std::string(http::to_string(name)), count),
                     "send it once");
      }
    }
    return std::nullopt;
  }

  /// Proxies add an address to the last head of this name, or a head behind it.
  [[nodiscard]] std::string last_forwarded() const {
    const auto [from, to] = parser_->get().equal_range("X-Forwarded-For");
    return from == to ? std::string() : std::string(std::prev(to)->value());
  }

  bool fill(Request& request) const {
    const auto& from = parser_->get();
    const auto head = [&from](const auto& name) { return std::string(from[name]); };
    request.method = std::string(from.method_string());
    request.host = head(http::field::host);
    request.origin = head(http::field::origin);
    request.authorization = head(http::field::authorization);
    request.cookie = head(http::field::cookie);
    request.content_type = head(http::field::content_type);
    request.csrf = head("X-Steadyrest-CSRF");
    request.body = from.body();
    request.address = client_address(traffic_.config.gate, address_, last_forwarded());
    request.secure = is_secure();
    const auto target = from.target();
    return parse_target({target.data(), target.size()}, request);
  }

  /// To the browser: a proxy in front encrypts.
  [[nodiscard]] bool is_secure() const {
    return kSecure || !traffic_.config.gate.outer_origin.empty();
  }

  /// In the thread of the answers.
  void answer(const Request& request, bool stream) {
    if (stream && request.path == traffic_.config.stream_path) {
      auto admitted = traffic_.handlers.admit(request);
      asio::post(traffic_.io,
                 [self = this->shared_from_this(), admitted = std::move(admitted)]() mutable {
                   self->upgrade(std::move(admitted));
                 });
      return;
    }
    Response response = traffic_.handlers.answer(request);
    if (!response.later) {
      deliver(std::move(response));
      return;
    }
    SlowAnswers& makes = response.minutes ? traffic_.slowest : traffic_.slow;
    const bool taken =
        makes.take([self = this->shared_from_this(),
                    later = std::move(response.later)](const std::stop_token& stop) mutable {
          return [self = std::move(self), made = later(stop)]() mutable {
            self->deliver(std::move(made));
            leave(std::move(self));
          };
        });
    if (!taken) {
      Response busy = error(503, "busy", "other long answers are being made",
                            "wait for them, or ask again later");
      busy.head.emplace_back("Retry-After", "5");
      deliver(std::move(busy));
    }
  }

  /// The last that holds a connection must be in the traffic's thread: its end changes what all
  /// connections share.
  static void leave(std::shared_ptr<Connection> self) {
    asio::io_context& io = self->traffic_.io;
    asio::post(io, [self = std::move(self)] {});
  }

  /// From any thread.
  void deliver(Response response) {
    asio::post(traffic_.io,
               [self = this->shared_from_this(), response = std::move(response)]() mutable {
                 self->write(std::move(response));
               });
  }

  void upgrade(std::variant<Server::Admitted, Response> admitted) {
    if (auto* refused = std::get_if<Response>(&admitted); refused != nullptr) {
      write(std::move(*refused));
    } else if (traffic_.streams.size() >= traffic_.config.most_streams) {
      write(error(503, "too_many_streams", "too many pages are open", "close one of them"));
    } else {
      beast::get_lowest_layer(transport_).expires_never();  // the stream has its own times
      std::make_shared<StreamClient<Transport>>(traffic_, std::move(transport_),
                                                std::move(std::get<Server::Admitted>(admitted)))
          ->accept(parser_->get());
    }
  }

  template <class Body>
  void send(http::response<Body> message, const Response& of) {
    message.result(of.status);
    message.version(11);
    message.keep_alive(!last_ && parser_->get().keep_alive());
    if (of.status != kNoContent) {
      message.set(http::field::content_type, of.content_type);
    }
    for (const auto& [name, value] : of.head) {
      message.insert(name, value);
    }
    const bool goes_on = message.keep_alive();
    auto kept = std::make_shared<http::response<Body>>(std::move(message));
    be_patient(of.file.empty() ? 0 : kept->payload_size().value_or(0));
    http::async_write(transport_, *kept,
                      [self = this->shared_from_this(), kept, goes_on](beast::error_code fault,
                                                                       std::size_t /*size*/) {
                        if (!fault && goes_on) {
                          self->read();
                        } else {
                          self->close();
                        }
                      });
  }

  void write(Response response) {
    add_security_heads(response, is_secure());
    if (response.status == kNoContent || parser_->get().method() == http::verb::head) {
      write_head(response);
      return;
    }
    if (response.file.empty()) {
      http::response<http::string_body> message;
      message.body() = std::move(response.body);
      message.prepare_payload();
      send(std::move(message), response);
      return;
    }
    http::response<http::file_body> message;
    beast::error_code fault;
    message.body().open(response.file.c_str(), beast::file_mode::scan, fault);
    response.keeper.reset();
    if (fault) {
      write(error(500, "failed", "the file cannot be read", "try again"));
      return;
    }
    message.prepare_payload();
    send(std::move(message), response);
  }

  /// With the length that the body would have.
  void write_head(Response& response) {
    http::response<http::empty_body> message;
    if (response.status != kNoContent) {
      std::error_code fault;
      const auto bytes = response.file.empty() ? response.body.size()
                                               : std::filesystem::file_size(response.file, fault);
      message.content_length(fault ? 0 : bytes);
    }
    response.keeper.reset();
    send(std::move(message), response);
  }

  void close() {
    if constexpr (kSecure) {
      beast::get_lowest_layer(transport_).expires_after(std::chrono::seconds(2));
      transport_.async_shutdown([self = this->shared_from_this()](beast::error_code) {});
    } else {
      beast::error_code fault;
      transport_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, fault);
    }
  }

  Traffic& traffic_;
  Transport transport_;
  std::string address_;
  beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  bool last_ = false;                                   ///< no request is read after this one
  std::optional<std::list<Waiting*>::iterator> place_;  ///< among those that wait
};

}  // namespace steadyrest::web
