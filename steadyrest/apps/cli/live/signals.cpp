// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <ctime>

#include <unistd.h>

#include <steadyrest/apps/cli/live/signals.hpp>

namespace steadyrest::apps::cli::live {
namespace {

using steadyrest::live::Loop;

std::atomic<Loop*> the_loop{nullptr};

/// A second one ends the process, whichever of them it is.
void on_signal(int number) {
  if (Loop* const loop = the_loop.exchange(nullptr); loop != nullptr) {
    loop->ask_stop();
  } else {
    ::signal(number, SIG_DFL);
    ::raise(number);
  }
}

sigset_t hangup() noexcept {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGHUP);
  return set;
}

}  // namespace

StopSignals::StopSignals(Loop& loop) {
  the_loop.store(&loop);
  struct sigaction now{};
  now.sa_handler = on_signal;
  now.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &now, &interrupt_);
  ::sigaction(SIGTERM, &now, &terminate_);
}

StopSignals::~StopSignals() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
  the_loop.store(nullptr);
}

HangupWaits::HangupWaits() : on_terminal_(::isatty(STDIN_FILENO) == 1) {
  const sigset_t set = hangup();
  ::pthread_sigmask(SIG_BLOCK, &set, &before_);
}

// One that comes at the very end would otherwise kill the process before it has said its figures.
HangupWaits::~HangupWaits() {
  const sigset_t set = hangup();
  const timespec at_once{};
  while (::sigtimedwait(&set, nullptr, &at_once) > 0) {
  }
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool HangupWaits::terminal_is_gone() const noexcept {
  return on_terminal_ && ::isatty(STDIN_FILENO) != 1;
}

}  // namespace steadyrest::apps::cli::live
