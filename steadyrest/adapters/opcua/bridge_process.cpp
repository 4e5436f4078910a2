// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/adapters/opcua/bridge_process.hpp>
#include <steadyrest/adapters/opcua/wire.hpp>
#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::link::monotonic_s;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr int kBridgesEnd = 3;
constexpr double kEnd_s = 0.5;  ///< for an end in good order
constexpr int kEndSteps = 50;

/// 0, or why the process did not start.
int spawn(const BridgeProcess::Config& config, int socket, pid_t& process) {
  std::string node = config.node;
  std::string script = config.script;
  std::array<char*, 3> arguments{node.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, socket, kBridgesEnd);
  // The layer's signals are for its own threads: the bridge starts with none of them blocked.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int fault =
      ::posix_spawnp(&process, node.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return fault;
}

}  // namespace

Result<std::unique_ptr<BridgeProcess>> BridgeProcess::start(const Config& config) {
  if (::access(config.script.c_str(), R_OK) != 0) {
    return unavailable(
        "the OPC UA bridge is not at " + config.script,
        "build it by scripts/opcua-bridge.sh, or name it in STEADYREST_OPCUA_BRIDGE");
  }
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) {
    return unavailable(std::string("no sockets for the OPC UA bridge: ") + std::strerror(errno),
                       "end other programs");
  }
  pid_t process = -1;
  const int fault = spawn(config, pair[1], process);
  ::close(pair[1]);
  if (fault != 0) {
    ::close(pair[0]);
    return unavailable(config.node + " does not start: " + std::strerror(fault),
                       "install Node 18 or newer (Debian: nodejs)");
  }
  return std::unique_ptr<BridgeProcess>(new BridgeProcess(process, pair[0]));
}

/// The closed socket ends the bridge, which closes its session; a bridge that hangs is killed.
BridgeProcess::~BridgeProcess() {
  ::close(socket_);
  for (int i = 0; i < kEndSteps; ++i) {
    if (::waitpid(process_, nullptr, WNOHANG) != 0) {
      return;
    }
    ::poll(nullptr, 0, static_cast<int>(1000.0 * kEnd_s / kEndSteps));
  }
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

bool BridgeProcess::send(const std::string& lines) {
  std::size_t sent = 0;
  while (sent < lines.size() && !ended_) {
    const ssize_t got =
        ::send(socket_, lines.data() + sent, lines.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    // A bridge that reads nothing is as good as ended.
    ended_ = got <= 0;
    sent += static_cast<std::size_t>(std::max<ssize_t>(got, 0));
  }
  return !ended_;
}

std::optional<std::string> BridgeProcess::next_line(double timeout_s) {
  const double until_s = monotonic_s() + timeout_s;
  for (;;) {
    if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
      std::string line = text_.substr(0, end);
      text_.erase(0, end + 1);
      return line;
    }
    const double left_s = until_s - monotonic_s();
    if (ended_ || text_.size() > kMaxLine) {
      ended_ = true;
      return std::nullopt;
    }
    pollfd waits{.fd = socket_, .events = POLLIN, .revents = 0};
    if (::poll(&waits, 1, std::max(0, static_cast<int>(1000.0 * left_s + 0.999))) <= 0) {
      if (monotonic_s() < until_s) {
        continue;  // a signal
      }
      return std::nullopt;
    }
    std::array<char, 16384> buffer{};
    const ssize_t got = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (got > 0) {
      text_.append(buffer.data(), static_cast<std::size_t>(got));
    } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
      ended_ = true;
    }
  }
}

}  // namespace steadyrest::adapters::opcua
