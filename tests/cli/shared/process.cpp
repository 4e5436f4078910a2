// SPDX-License-Identifier: Apache-2.0
#include "process.hpp"

#include <array>
#include <csignal>
#include <cstddef>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace steadyrest::test {
namespace {

/// The pipe's reading end is closed: the first write fails, as with `| head`.
void redirect_stdout(Process::Stdout out) {
  if (out == Process::Stdout::nowhere) {
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    return;
  }
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) == 0) {
    dup2(pipe[1], STDOUT_FILENO);
    close(pipe[0]);
    close(pipe[1]);
  }
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::string& folder,
                 Limits limits) {
  std::vector<char*> argv = {const_cast<char*>("steadyrest")};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  // Close-on-exec, so that the child's own children cannot keep the pipe open.
  std::array<int, 2> err{};
  if (pipe2(err.data(), O_CLOEXEC) != 0) {
    return;
  }
  err_read_ = err[0];
  child_ = fork();
  if (child_ == 0) {
    dup2(err[1], STDERR_FILENO);
    redirect_stdout(limits.out);
    // The kernel refuses writes beyond it: a full disk without a disk.
    if (limits.largest_file >= 0) {
      const auto most = static_cast<rlim_t>(limits.largest_file);
      const rlimit limit{most, most};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (chdir(folder.c_str()) == 0) {
      execv(STEADYREST_PROGRAM, argv.data());
    }
    _exit(127);
  }
  close(err[1]);
  // glibc 2.36 declares pidfd_open() for C alone.
  pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, child_, 0));
}

/// A test that fails early must not leave a process behind.
Process::~Process() {
  if (child_ > 0) {
    send(SIGKILL);
    wait();
  }
  close(pidfd_);
  close(err_read_);
}

void Process::send(int signal) const noexcept {
  if (child_ > 0) {
    kill(child_, signal);
  }
}

int Process::wait() {
  if (child_ <= 0) {
    return code_;
  }
  // Read to the end first: a child that fills the pipe would wait forever.
  std::array<char, 4096> block{};
  for (ssize_t got = 0; (got = read(err_read_, block.data(), block.size())) > 0;) {
    err_.append(block.data(), static_cast<std::size_t>(got));
  }
  int status = 0;
  waitpid(child_, &status, 0);
  child_ = -1;
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return code_;
}

}  // namespace steadyrest::test
