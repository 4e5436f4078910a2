// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <fmt/core.h>

#include <steadyrest/web/traffic.hpp>

namespace steadyrest::web {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

/// A WebSocket's client. It may send pongs alone: one that says anything is closed.
template <class Transport>
class StreamClient final : public Stream,
                           public std::enable_shared_from_this<StreamClient<Transport>> {
 public:
  StreamClient(Traffic& traffic, Transport transport, Server::Admitted admitted,
               std::string address)
      : traffic_(traffic),
        socket_(std::move(transport)),
        admitted_(std::move(admitted)),
        address_(std::move(address)) {}
  StreamClient(const StreamClient&) = delete;
  StreamClient& operator=(const StreamClient&) = delete;
  ~StreamClient() override { leave(); }

  void accept(const http::request<http::string_body>& request) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = std::chrono::seconds(5);
    timeout.idle_timeout = std::chrono::seconds(20);  // its pongs count
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.read_message_max(kMostSaid);
    socket_.auto_fragment(false);
    writing_ = true;  // nothing is sent before the handshake is
    write_begun_ = Clock::now();
    traffic_.streams.push_back(this);
    traffic_.stream_count.store(traffic_.streams.size());
    socket_.async_accept(request, [self = this->shared_from_this()](beast::error_code fault) {
      self->writing_ = false;
      if (!fault) {
        self->begin();
      } else {
        self->leave();
      }
    });
  }

  void publish(const std::shared_ptr<const std::string>& newest) override {
    missed_ += newest_ ? 1 : 0;
    newest_ = newest;
    write();
  }

  void announce(const std::shared_ptr<const std::string>& message) override {
    if (waiting_.size() >= kMostWaiting) {
      close(websocket::close_code::try_again_later);
      return;
    }
    waiting_.push_back(message);
    write();
  }

  void offer(const std::shared_ptr<const std::string>& message) override {
    if (waiting_.empty() && !newest_) {
      announce(message);
    }
  }

  void look() override {
    const double patience_s = traffic_.config.patience_s;
    if (writing_ &&
        std::chrono::duration<double>(Clock::now() - write_begun_).count() > patience_s) {
      give_way();
    } else if (!admitted_.goes_on()) {
      close(websocket::close_code::policy_error);
    }
  }

  /// Its client may not even take a word of farewell.
  void give_way() override {
    leave();
    beast::get_lowest_layer(socket_).close();
  }

  [[nodiscard]] const std::string& address() const override { return address_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostSaid = 4096;
  static constexpr std::size_t kMostWaiting = 8;

  void begin() {
    waiting_.push_front(std::make_shared<const std::string>(std::move(admitted_.first)));
    write();
    listen();
  }

  void leave() {
    std::erase(traffic_.streams, this);
    traffic_.stream_count.store(traffic_.streams.size());
  }

  void listen() {
    socket_.async_read(
        said_, [self = this->shared_from_this()](beast::error_code fault, std::size_t /*size*/) {
          if (!fault) {
            self->close(websocket::close_code::policy_error);
          } else {
            self->give_way();  // a write may still be waiting for it
          }
        });
  }

  /// It is looked at until its client has heard of it.
  void close(websocket::close_code why) {
    if (!closing_) {
      closing_ = true;
      closes_for_ = why;
      write();
    }
  }

  void write() {
    if (writing_) {
      return;
    }
    if (closing_) {
      writing_ = true;  // for good
      write_begun_ = Clock::now();
      socket_.async_close(closes_for_, [self = this->shared_from_this()](beast::error_code) {});
      return;
    }
    if (!waiting_.empty()) {
      out_ = *waiting_.front();
      waiting_.pop_front();
    } else if (newest_) {
      out_ = fmt::format("{{\"missed\":{},{}", missed_, *newest_);
      newest_.reset();
      missed_ = 0;
    } else {
      return;
    }
    writing_ = true;
    write_begun_ = Clock::now();
    socket_.text(true);
    socket_.async_write(asio::buffer(out_), [self = this->shared_from_this()](
                                                beast::error_code fault, std::size_t /*size*/) {
      self->writing_ = false;
      if (!fault) {
        self->write();
      } else {
        self->leave();
      }
    });
  }

  Traffic& traffic_;
  websocket::stream<Transport> socket_;
  Server::Admitted admitted_;
  std::string address_;
  beast::flat_buffer said_;
  std::deque<std::shared_ptr<const std::string>> waiting_;
  std::shared_ptr<const std::string> newest_;
  std::size_t missed_ = 0;
  std::string out_;
  bool writing_ = false;
  Clock::time_point write_begun_;
  bool closing_ = false;
  websocket::close_code closes_for_ = websocket::close_code::normal;
};

}  // namespace steadyrest::web
