// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/adapters/linuxcnc/sample_queue.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

/// Above this a double no longer counts by one.
constexpr double kLargestTick = 9.0e15;

bool is_tick(double tick) noexcept {
  return tick >= 0.0 && tick <= kLargestTick && tick == std::floor(tick);
}

}  // namespace

bool SampleQueue::fill(HalSide& hal) noexcept {
  for (std::size_t c = 0; c < channels_; ++c) {
    held_[c] = held_[c] || hal.read_row(c, row_[c]);
    if (!held_[c]) {
      return false;
    }
  }
  return true;
}

SampleQueue::Got SampleQueue::next(HalSide& hal, Sample& sample) noexcept {
  for (std::size_t i = 0; i < kMostRows; ++i) {
    if (!fill(hal)) {
      return Got::none;
    }
    double newest = 0.0;
    for (std::size_t c = 0; c < channels_; ++c) {
      if (!is_tick(row_[c][0])) {
        held_.fill(false);
        return Got::not_a_tick;
      }
      newest = std::max(newest, row_[c][0]);
    }
    bool joined = true;
    for (std::size_t c = 0; c < channels_; ++c) {
      held_[c] = row_[c][0] == newest;
      joined = joined && held_[c];
    }
    if (joined) {
      return take(sample);
    }
  }
  return Got::none;
}

SampleQueue::Got SampleQueue::take(Sample& sample) noexcept {
  held_.fill(false);
  const double tick = row_[0][0];
  if (tick <= last_tick_) {
    return tick == last_tick_ ? Got::frozen : Got::restarted;
  }
  if (last_tick_ >= 0.0) {
    missed_ += static_cast<std::uint64_t>(tick - last_tick_) - 1;
  }
  last_tick_ = tick;
  sample.tick = static_cast<std::uint64_t>(tick);
  sample.state = row_[0];
  for (std::size_t a = 0; a < axes_; ++a) {
    const Row& row = row_[1 + a / kAxesPerChannel];
    const std::size_t column = 1 + kAxisColumns * (a % kAxesPerChannel);
    sample.axis[a] = {row[column], row[column + 1], row[column + 2], row[column + 3]};
  }
  return Got::sample;
}

}  // namespace steadyrest::adapters::linuxcnc
