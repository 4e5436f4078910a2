// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <thread>
#include <utility>

#include <boost/asio.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::live {
namespace {

namespace asio = boost::asio;
using asio::local::stream_protocol;
using boost::system::error_code;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kCheck_s = 2.0;
constexpr auto kPauseAfterFault = std::chrono::milliseconds(100);
constexpr std::string_view kTooLong =
    R"({"version":1,"error":{"what":"the line is too long; allowed: 4096 bytes","to_do":"send one request in a line"}})";

/// One client: a line, its answer, the next line.
class Client : public std::enable_shared_from_this<Client> {
 public:
  using All = std::list<Client*>;  ///< the one that has said nothing for longest is first

  Client(stream_protocol::socket socket, const ControlSocket::Answer& answer, All& all)
      : socket_(std::move(socket)), answer_(answer), all_(all), buffer_(kMostLine) {
    all_.push_back(this);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { std::erase(all_, this); }

  /// Each answer is made at once: whoever is here waits for the client alone.
  void give_way() {
    std::erase(all_, this);
    error_code ignored;
    ignored = socket_.close(ignored);
  }

  void next() {
    asio::async_read_until(socket_, buffer_, '\n',
                           [self = shared_from_this()](error_code fault, std::size_t size) {
                             self->got(fault, size);
                           });
  }

 private:
  void got(error_code fault, std::size_t size) {
    if (fault == asio::error::not_found) {  // the buffer is full, and no line in it
      say(std::string(kTooLong), true);
      return;
    }
    if (fault) {
      return;
    }
    const auto* const data = static_cast<const char*>(buffer_.data().data());
    const std::string line(data, size - 1);
    buffer_.consume(size);
    if (const auto at = std::ranges::find(all_, this); at != all_.end()) {
      all_.splice(all_.end(), all_, at);
    }
    say(answer_(line), false);
  }

  void say(std::string text, bool last) {
    out_ = std::move(text);
    out_ += '\n';
    asio::async_write(socket_, asio::buffer(out_),
                      [self = shared_from_this(), last](error_code fault, std::size_t /*size*/) {
                        if (!fault && !last) {
                          self->next();
                        }
                      });
  }

  stream_protocol::socket socket_;
  const ControlSocket::Answer& answer_;
  All& all_;
  asio::streambuf buffer_;
  std::string out_;
};

class Server final : public ControlSocket {
 public:
  Server(std::string path, Answer answer)
      : path_(std::move(path)), answer_(std::move(answer)), acceptor_(io_), pause_(io_) {}
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server() override {
    io_.stop();
    if (thread_.joinable()) {
      thread_.join();
    }
    if (bound_) {
      ::unlink(path_.c_str());
    }
  }

  /// Under another name until it listens, so that a socket which is there answers. In place of that
  /// of a dead program.
  Result<void> start() {
    std::string made = path_;
    made.back() = made.back() == '~' ? '-' : '~';
    ::unlink(made.c_str());
    error_code fault;
    fault = acceptor_.open(stream_protocol(), fault);
    const mode_t before = ::umask(S_IXUSR | S_IRWXG | S_IRWXO);
    if (!fault) {
      fault = acceptor_.bind(stream_protocol::endpoint(made), fault);
    }
    ::umask(before);
    if (!fault) {
      fault = acceptor_.listen(asio::socket_base::max_listen_connections, fault);
    }
    if (!fault) {
      bound_ = ::rename(made.c_str(), path_.c_str()) == 0;
      fault = bound_ ? fault : error_code(errno, boost::system::system_category());
    }
    if (fault) {
      ::unlink(made.c_str());
      return refuse(path_, fmt::format("the socket cannot be made: {}", fault.message()),
                    "give --socket with a folder that you may write to");
    }
    accept();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code fault, stream_protocol::socket socket) {
      if (!fault) {
        if (clients_.size() >= kMostClients) {
          clients_.front()->give_way();
        }
        std::make_shared<Client>(std::move(socket), answer_, clients_)->next();
      }
      if (!acceptor_.is_open()) {
        return;
      }
      if (fault) {
        // Where the process has no descriptor left, the client that waits makes each accept fail at
        // once.
        pause_.expires_after(kPauseAfterFault);
        pause_.async_wait([this](error_code /*fault*/) { accept(); });
      } else {
        accept();
      }
    });
  }

  std::string path_;
  Answer answer_;
  Client::All clients_;
  asio::io_context io_{1};
  stream_protocol::acceptor acceptor_;
  asio::steady_timer pause_;
  std::thread thread_;
  bool bound_ = false;
};

/// By the system's own timeout, as all calls of this socket: they block, connect() too.
error_code connected(stream_protocol::socket& socket, const std::string& path, double timeout_s) {
  error_code fault;
  fault = socket.open(stream_protocol(), fault);
  const auto whole = static_cast<time_t>(timeout_s);
  const timeval most{
      .tv_sec = whole,
      .tv_usec = static_cast<suseconds_t>(1e6 * (timeout_s - static_cast<double>(whole)))};
  ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
  ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);
  return fault ? fault : socket.connect(stream_protocol::endpoint(path), fault);
}

bool fits(const std::string& path) noexcept {
  return !path.empty() && path.size() < sizeof(sockaddr_un::sun_path);
}

}  // namespace

std::string usual_socket() {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  return fmt::format("{}/steadyrest.sock", folder != nullptr && *folder != '\0' ? folder : "/run");
}

Result<void> ControlSocket::check(const std::string& path) {
  if (!fits(path)) {
    return refuse(path,
                  fmt::format("the socket's path has {} bytes; allowed: 1 … {}", path.size(),
                              sizeof(sockaddr_un::sun_path) - 1),
                  "give a shorter --socket");
  }
  struct stat file{};
  if (::lstat(path.c_str(), &file) != 0) {
    return {};
  }
  if (!S_ISSOCK(file.st_mode)) {
    return refuse(path, "is a file and no socket", "give another --socket");
  }
  asio::io_context io;
  stream_protocol::socket other(io);
  error_code fault;
  fault = connected(other, path, kCheck_s);
  if (fault == asio::error::connection_refused || fault == error_code(ENOENT, fault.category())) {
    return {};
  }
  return refuse(path,
                !fault ? "another layer answers on this socket"
                       : "another layer may be on this socket: " + fault.message(),
                "stop it first, or give another --socket");
}

Result<std::unique_ptr<ControlSocket>> ControlSocket::open(const std::string& path, Answer answer) {
  if (auto free = check(path); !free) {
    return std::unexpected(std::move(free.error()));
  }
  auto server = std::make_unique<Server>(path, std::move(answer));
  if (auto started = server->start(); !started) {
    return std::unexpected(std::move(started.error()));
  }
  return server;
}

Result<std::string> ask(const std::string& path, const std::string& line, double timeout_s) {
  const auto none = [&](const std::string& why) {
    return kernel::outcome::unavailable(fmt::format("no layer answers on {}: {}", path, why),
                                        "start one with `steadyrest run`, or give its --socket");
  };
  // Whoever is told that there is none starts a second one.
  const auto silent = [&](const std::string& why) {
    return kernel::outcome::unavailable(
        fmt::format("the layer on {} runs but {}", path, why),
        "try again; where it goes on like this, take the machine over at its panel before you end "
        "the layer");
  };
  if (!fits(path)) {
    return refuse(path, "is no path of a socket", "give the --socket of the layer");
  }
  asio::io_context io;
  stream_protocol::socket socket(io);
  error_code fault;
  fault = connected(socket, path, timeout_s);
  if (fault == asio::error::no_buffer_space) {  // what Asio makes of EAGAIN
    return silent("does not take the connection");
  }
  if (fault == asio::error::access_denied) {
    return kernel::outcome::unavailable(
        fmt::format("the layer on {} belongs to another user", path),
        "ask it as that user: sudo -u USER steadyrest …");
  }
  if (fault) {
    return none(fault.message());
  }
  const std::string out = line + '\n';
  std::string in;
  if (::send(socket.native_handle(), out.data(), out.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(out.size())) {
    return silent("does not take the request");
  }
  std::array<char, 1024> part{};
  while (in.find('\n') == std::string::npos) {
    const ssize_t got = ::recv(socket.native_handle(), part.data(), part.size(), 0);
    if (got <= 0) {
      return silent(got == 0 || errno == ECONNRESET
                        ? "has closed the connection: others ask it without end"
                        : fmt::format("has not answered within {} s", timeout_s));
    }
    in.append(part.data(), static_cast<std::size_t>(got));
  }
  in.resize(in.find('\n'));
  return in;
}

}  // namespace steadyrest::live
