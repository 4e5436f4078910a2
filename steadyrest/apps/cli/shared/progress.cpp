// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/apps/cli/shared/progress.hpp>

namespace steadyrest::apps::cli {
namespace {

/// Nothing for the first second: a bar that flashes up and goes is worse than none. Then at most
/// ten draws a second, and one a second even if the work makes no call.
constexpr std::chrono::milliseconds kQuiet{1000};
constexpr std::chrono::milliseconds kBetween{100};
constexpr std::chrono::milliseconds kTick{1000};
constexpr std::size_t kCells = 30;

std::string repeated(std::string_view cell, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) {
    out += cell;
  }
  return out;
}

}  // namespace

/// The thread only ticks the seconds. It draws nothing unless the bar is up, and it waits on a
/// condition so that the end of a short verb is not delayed.
Progress::Progress() : Progress(stderr, isatty(STDERR_FILENO) == 1, Clock::now()) {
  if (terminal_) {
    ticker_ = std::thread([this] {
      std::unique_lock lock(mutex_);
      while (!end_.wait_for(lock, kTick, [this] { return ended_; })) {
        // tick_at() takes the lock itself.
        lock.unlock();
        tick_at(Clock::now());
        lock.lock();
      }
    });
  }
}

/// The thread must end before clear(), or it could draw after it.
Progress::~Progress() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  if (ticker_.joinable()) {
    end_.notify_all();
    ticker_.join();
  }
  clear();
}

/// Called often, so everything but a comparison is left to the few calls that draw.
void Progress::update_at(Clock::time_point now, double share, std::string_view what) {
  if (!terminal_) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  // A NaN share counts as 0: progress must never stop the work.
  share_ = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  what_ = what;
  cleared_ = false;
  if (now - start_ >= kQuiet && (!drawn_ || now - last_ >= kBetween)) {
    draw(now);
  }
}

void Progress::tick_at(Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  if (terminal_ && !cleared_ && now - start_ >= kQuiet && now - last_ >= kTick) {
    draw(now);
  }
}

void Progress::draw(Clock::time_point now) {
  last_ = now;
  drawn_ = true;
  const auto full = static_cast<std::size_t>(share_ * static_cast<double>(kCells));
  // \r and erase-to-end-of-line: the bar stays on one line, whatever was longer before.
  fmt::print(stream_, "\r\x1b[K{}{} {:3.0f} %  {}, {} s", repeated("█", full),
             repeated("░", kCells - full), share_ * 100.0, what_,
             std::chrono::duration_cast<std::chrono::seconds>(now - start_).count());
  std::fflush(stream_);
}

void Progress::clear() {
  const std::scoped_lock lock(mutex_);
  cleared_ = true;
  if (drawn_) {
    std::fputs("\r\x1b[K", stream_);
    std::fflush(stream_);
    drawn_ = false;
  }
}

}  // namespace steadyrest::apps::cli
