// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/adapters/linuxcnc/control_script.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr const char* kInstall = "install linuxcnc-uspace with its Python modules";

/// 0, or why the process did not start; its output is `out`.
int spawn(const ControlPeer::Config& config, int out, pid_t& process) {
  std::string python = config.python;
  std::string script = config.script.empty() ? std::string(kControlScript) : config.script;
  std::string option = "-c";
  std::array<char*, 4> arguments{python.data(), option.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const int fault =
      ::posix_spawn(&process, config.python.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return fault;
}

}  // namespace

Result<std::unique_ptr<ControlPeer>> ControlPeer::start(const Config& config) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return unavailable(std::string("no pipe for LinuxCNC's status: ") + std::strerror(errno),
                       kInstall);
  }
  pid_t process = -1;
  const int fault = spawn(config, pipe[1], process);
  ::close(pipe[1]);
  if (fault != 0) {
    ::close(pipe[0]);
    return unavailable(config.python + " does not start: " + std::strerror(fault), kInstall);
  }
  return std::unique_ptr<ControlPeer>(new ControlPeer(process, pipe[0]));
}

ControlPeer::~ControlPeer() {
  ::close(pipe_);
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

Result<std::optional<ControlState>> ControlPeer::next(double timeout_s) {
  pollfd waits{.fd = pipe_, .events = POLLIN, .revents = 0};
  if (::poll(&waits, 1, static_cast<int>(1000.0 * timeout_s)) <= 0) {
    return std::optional<ControlState>();
  }
  std::array<char, 65536> buffer{};
  const ssize_t got = ::read(pipe_, buffer.data(), buffer.size());
  if (got < 0 && errno == EINTR) {
    return std::optional<ControlState>();
  }
  if (got <= 0) {
    return unavailable("the process that reads LinuxCNC's status has ended", kInstall);
  }
  text_.append(buffer.data(), static_cast<std::size_t>(got));
  const std::size_t end = text_.rfind('\n');
  if (end == std::string::npos) {
    return std::optional<ControlState>();
  }
  const std::size_t before = end == 0 ? std::string::npos : text_.rfind('\n', end - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  auto state = control_state(std::string_view(text_).substr(begin, end - begin));
  text_.erase(0, end + 1);
  if (!state) {
    return std::unexpected(std::move(state.error()));
  }
  return std::optional<ControlState>(std::move(*state));
}

}  // namespace steadyrest::adapters::linuxcnc
