// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iterator>
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
class Connection final : public Guest, public std::enable_shared_from_this<Connection<Transport>> {
 public:
  static constexpr bool kSecure = std::is_same_v<Transport, TlsTransport>;

  /// In a kept place only urgent requests are answered.
  Connection(Traffic& traffic, Transport transport, std::string address, bool kept)
      : traffic_(traffic), transport_(std::move(transport)), address_(std::move(address)) {
    seat_.emplace(traffic_.guests, address_, kept, *this);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() override = default;

  void give_way() override {
    seat_.reset();
    beast::get_lowest_layer(transport_).close();
  }

  void begin() {
    if constexpr (kSecure) {
      be_patient();
      waits();
      transport_.async_handshake(asio::ssl::stream_base::server,
                                 [self = this->shared_from_this()](beast::error_code fault) {
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

  using Clock = std::chrono::steady_clock;

  /// A message on its way, and how much of it the client has taken.
  template <class Body>
  struct Outgoing {
    http::response<Body> message;
    http::response_serializer<Body> serializer{message};
    Clock::time_point begun = Clock::now();
    std::size_t taken = 0;
  };

  /// The whole of what follows, not each of its bytes, must come within this time.
  void be_patient() { be_patient(Clock::now(), 0); }
  /// A client that takes nothing is cut off after this time; one that goes on taking has more.
  void be_patient(Clock::time_point begun, std::size_t taken) {
    const double s =
        traffic_.config.patience_s + static_cast<double>(taken) / traffic_.config.slowest_bytes_s;
    beast::get_lowest_layer(transport_)
        .expires_at(begun + std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * s)));
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(traffic_.config.most_head));
    parser_->body_limit(traffic_.config.most_body);
    be_patient();
    waits();
    http::async_read(transport_, buffer_, *parser_,
                     [self = this->shared_from_this()](beast::error_code fault, std::size_t) {
                       self->got(fault);
                     });
  }

  void waits() {
    if (seat_) {
      seat_->waits();
    }
  }
  [[nodiscard]] bool is_kept() const { return seat_ && seat_->is_kept(); }

  void got(beast::error_code fault) {
    if (fault) {
      unreadable(fault);
      return;
    }
    auto refused = repeated();
    if (!refused) {
      refused = refuse_framing(framing());
    }
    if (refused) {
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
    client_ = request.address;
    const bool stream = websocket::is_upgrade(parser_->get());
    const bool writes = stream || (request.method != "GET" && request.method != "HEAD");
    refused = traffic_.gate.refuse(request, writes, traffic_.handlers.now_s());
    const bool urgent = traffic_.gate.is_urgent(request);
    if (!refused && is_kept() && !urgent) {
      last_ = true;
      refused = busy("all connections are being answered");
    }
    if (refused) {
      write(std::move(*refused));
      return;
    }
    if (seat_) {
      seat_->works();
    }
    traffic_.answers.take(
        [self = this->shared_from_this(), stream, request = std::move(request)]() mutable {
          self->answer(request, stream);
          leave(std::move(self));
        },
        urgent);
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

  static Response busy(const std::string& what) {
    Response out = error(503, "busy", what, "wait for them, or ask again later");
    out.head.emplace_back("Retry-After", "5");
    return out;
  }

  /// How the request says where its body ends.
  [[nodiscard]] Framing framing() const {
    const auto& from = parser_->get();
    Framing out;
    out.length = std::string(from[http::field::content_length]);
    out.knows_chunks = from.version() >= 11;
    const auto [begin, end] = from.equal_range(http::field::transfer_encoding);
    for (auto at = begin; at != end; ++at) {
      out.codings.emplace_back(at->value());
    }
    return out;
  }

  /// A proxy in front might go by the other one.
  [[nodiscard]] std::optional<Response> repeated() const {
    constexpr std::array kOnce = {http::field::host, http::field::origin,
                                  http::field::authorization, http::field::content_type,
                                  http::field::content_length};
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
    SlowAnswers& makes = response.takes == Takes::minutes   ? traffic_.slowest
                         : response.takes == Takes::hashing ? traffic_.hashing
                                                            : traffic_.slow;
    const bool taken = makes.take(
        request.address, [self = this->shared_from_this(),
                          later = std::move(response.later)](const std::stop_token& stop) mutable {
          return [self = std::move(self), made = later(stop)]() mutable {
            self->deliver(std::move(made));
            leave(std::move(self));
          };
        });
    if (!taken) {
      deliver(busy("other long answers are being made"));
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
    } else if (!traffic_.has_room_for_stream(client_)) {
      write(error(503, "too_many_streams", "too many pages are open", "close one of them"));
    } else {
      beast::get_lowest_layer(transport_).expires_never();  // the stream has its own times
      std::make_shared<StreamClient<Transport>>(
          traffic_, std::move(transport_), std::move(std::get<Server::Admitted>(admitted)), client_)
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
    waits();
    write_some(std::make_shared<Outgoing<Body>>(std::move(message)));
  }

  template <class Body>
  void write_some(std::shared_ptr<Outgoing<Body>> out) {
    be_patient(out->begun, out->taken);
    auto& serializer = out->serializer;
    http::async_write_some(transport_, serializer,
                           [self = this->shared_from_this(), out = std::move(out)](
                               beast::error_code fault, std::size_t size) mutable {
                             out->taken += size;
                             self->wrote(fault, std::move(out));
                           });
  }

  template <class Body>
  void wrote(beast::error_code fault, std::shared_ptr<Outgoing<Body>> out) {
    waits();
    if (!fault && !out->serializer.is_done()) {
      write_some(std::move(out));
    } else if (!fault && out->message.keep_alive()) {
      read();
    } else {
      close();
    }
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
      waits();
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
  std::string client_;                ///< address of who asks, behind a proxy too
  bool last_ = false;                 ///< no request is read after this one
  std::optional<Guests::Seat> seat_;  ///< none: it has given way
};

}  // namespace steadyrest::web
