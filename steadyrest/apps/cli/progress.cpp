// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/apps/cli/progress.hpp>

namespace steadyrest::apps::cli {
namespace {

constexpr std::chrono::milliseconds kQuiet{1000};
constexpr std::chrono::milliseconds kBetween{100};
constexpr std::size_t kCells = 30;

std::string repeated(std::string_view cell, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) {
    out += cell;
  }
  return out;
}

}  // namespace

Progress::Progress() : Progress(stderr, isatty(STDERR_FILENO) == 1, Clock::now()) {}

void Progress::update_at(Clock::time_point now, double share, std::string_view what) {
  if (!terminal_ || now - start_ < kQuiet || (drawn_ && now - last_ < kBetween)) {
    return;
  }
  last_ = now;
  drawn_ = true;
  const double known = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  const auto full = static_cast<std::size_t>(known * static_cast<double>(kCells));
  fmt::print(stream_, "\r\x1b[K{}{} {:3.0f} %  {}", repeated("█", full),
             repeated("░", kCells - full), known * 100.0, what);
  std::fflush(stream_);
}

void Progress::clear() {
  if (drawn_) {
    std::fputs("\r\x1b[K", stream_);
    std::fflush(stream_);
    drawn_ = false;
  }
}

}  // namespace steadyrest::apps::cli
