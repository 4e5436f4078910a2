// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/web/connection.hpp>
#include <steadyrest/web/listen.hpp>
#include <steadyrest/web/server.hpp>

namespace steadyrest::web {
namespace {

using asio::ip::tcp;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr auto kPauseAfterFault = std::chrono::milliseconds(100);
constexpr auto kLook = std::chrono::seconds(1);
constexpr int kMostAtOnce = 256;

// New connections of one address, and of all: further ones get the kept places alone. Each costs
// the traffic's thread about a millisecond with its answer.
constexpr RateLimit::Config kNewOfOne{.per_s = 150.0, .burst = 300.0, .most_keys = 4096};
constexpr RateLimit::Config kNewOfAll{.per_s = 300.0, .burst = 600.0, .most_keys = 1};

class BeastServer final : public Server {
 public:
  BeastServer(Config config, Handlers handlers)
      : traffic_(std::move(config), std::move(handlers)),
        acceptor_(traffic_.io),
        pause_(traffic_.io),
        look_(traffic_.io) {}
  BeastServer(const BeastServer&) = delete;
  BeastServer& operator=(const BeastServer&) = delete;
  ~BeastServer() override {
    traffic_.answers.join();
    traffic_.slow.end();
    traffic_.slowest.end();
    traffic_.io.stop();
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  Result<void> start() {
    if (auto ready = prepare_tls(); !ready) {
      return ready;
    }
    const Config& config = traffic_.config;
    beast::error_code fault;
    const auto address = asio::ip::make_address(config.address, fault);
    if (fault) {
      return refuse(fmt::format("{} is not an address", config.address),
                    "give --listen ADDRESS:PORT, the address as numbers");
    }
    const tcp::endpoint endpoint(address, config.port);
    fault = acceptor_.open(endpoint.protocol(), fault);
    if (!fault) {
      fault = acceptor_.set_option(asio::socket_base::reuse_address(true), fault);
    }
    if (!fault) {
      fault = acceptor_.bind(endpoint, fault);
    }
    if (!fault) {
      fault = acceptor_.listen(asio::socket_base::max_listen_connections, fault);
    }
    if (fault) {
      return refuse(fmt::format("{} port {}: {}", config.address, config.port, fault.message()),
                    "give another --listen");
    }
    fault = acceptor_.non_blocking(true, fault);
    port_ = acceptor_.local_endpoint().port();
    accept();
    look();
    thread_ = std::thread([this] { traffic_.io.run(); });
    return {};
  }

  [[nodiscard]] std::uint16_t port() const noexcept override { return port_; }
  [[nodiscard]] std::size_t streams() const noexcept override {
    return traffic_.stream_count.load();
  }
  void publish(std::shared_ptr<const std::string> newest) override {
    asio::post(traffic_.io, [this, newest = std::move(newest)] {
      each([&newest](Stream& stream) { stream.publish(newest); });
    });
  }
  void announce(std::shared_ptr<const std::string> message) override {
    asio::post(traffic_.io, [this, message = std::move(message)] {
      each([&message](Stream& stream) { stream.announce(message); });
    });
  }
  void offer(std::shared_ptr<const std::string> message) override {
    asio::post(traffic_.io, [this, message = std::move(message)] {
      each([&message](Stream& stream) { stream.offer(message); });
    });
  }

 private:
  /// A stream may leave while it is told.
  template <class Tell>
  void each(Tell tell) {
    const std::vector<Stream*> all(traffic_.streams.begin(), traffic_.streams.end());
    for (Stream* const stream : all) {
      tell(*stream);
    }
  }

  Result<void> prepare_tls() {
    const Config& config = traffic_.config;
    if (config.certificate.empty()) {
      return {};
    }
    tls_.emplace(asio::ssl::context::tls_server);
    ::SSL_CTX_set_min_proto_version(tls_->native_handle(), TLS1_2_VERSION);
    beast::error_code fault;
    fault = tls_->use_certificate_chain_file(config.certificate, fault);
    if (fault) {
      return refuse(config.certificate, "is no certificate that can be used: " + fault.message(),
                    "give --tls-certificate a PEM file, the server's own certificate first");
    }
    fault = tls_->use_private_key_file(config.key, asio::ssl::context::pem, fault);
    if (fault) {
      return refuse(config.key, "is no key of this certificate: " + fault.message(),
                    "give --tls-key the PEM file of its key, without a password");
    }
    return {};
  }

  void accept() {
    acceptor_.async_accept([this](beast::error_code fault, tcp::socket socket) {
      // All that have come: those of a flood must not keep others waiting behind them.
      for (int i = 0; !fault && i < kMostAtOnce; ++i) {
        take(std::move(socket));
        socket = tcp::socket(traffic_.io);
        fault = acceptor_.accept(socket, fault);
      }
      if (!acceptor_.is_open()) {
        return;
      }
      fault = fault == asio::error::would_block ? beast::error_code() : fault;
      if (fault) {
        pause_.expires_after(kPauseAfterFault);
        pause_.async_wait([this](beast::error_code /*fault*/) { accept(); });
      } else {
        accept();
      }
    });
  }

  void take(tcp::socket socket) {
    beast::error_code fault;
    const auto from = socket.remote_endpoint(fault);
    // A client has one address, whichever protocol it came by.
    const std::string address = fault ? "" : address_of(from.address().to_string()).value_or("");
    if (fault || !may_connect(traffic_.config.gate, address)) {
      return;  // it is closed
    }
    const double now_s = traffic_.handlers.now_s();
    const bool floods = !of_one_.take(address, now_s) || !of_all_.take("", now_s);
    if (floods && says_else(socket)) {
      return;
    }
    const auto place = floods ? traffic_.guests.find_kept(address) : traffic_.guests.find(address);
    if (place == Guests::Place::none) {
      return;
    }
    const bool kept = place == Guests::Place::kept;
    fault = socket.set_option(tcp::no_delay(true), fault);  // else a frame may come late
    if (tls_) {
      std::make_shared<Connection<TlsTransport>>(
          traffic_, TlsTransport(beast::tcp_stream(std::move(socket)), *tls_), address, kept)
          ->begin();
    } else {
      std::make_shared<Connection<PlainTransport>>(traffic_, PlainTransport(std::move(socket)),
                                                   address, kept)
          ->begin();
    }
  }

  /// It has sent the begin of a request that is not urgent. Over TLS nobody can tell.
  bool says_else(tcp::socket& socket) const {
    const std::string urgent = "POST " + traffic_.config.gate.urgent_path;
    std::array<char, 64> said{};
    const ssize_t got =
        tls_ ? 0
             : ::recv(socket.native_handle(), said.data(), said.size(), MSG_PEEK | MSG_DONTWAIT);
    const std::string_view begin(said.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return !begin.empty() && begin.substr(0, urgent.size()) != urgent.substr(0, begin.size());
  }

  void look() {
    look_.expires_after(kLook);
    look_.async_wait([this](beast::error_code /*fault*/) {
      each([](Stream& stream) { stream.look(); });
      look();
    });
  }

  // The connections that the traffic's handlers hold use the TLS context: it goes last.
  std::optional<asio::ssl::context> tls_;
  Traffic traffic_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  asio::steady_timer look_;
  RateLimit of_one_{kNewOfOne};
  RateLimit of_all_{kNewOfAll};
  std::uint16_t port_ = 0;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Server>> Server::open(Config config, Handlers handlers) {
  auto server = std::make_unique<BeastServer>(std::move(config), std::move(handlers));
  if (auto started = server->start(); !started) {
    return std::unexpected(std::move(started.error()));
  }
  return server;
}

}  // namespace steadyrest::web
