// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <utility>

#include <steadyrest/apps/cli/live/repeating_port.hpp>

namespace steadyrest::apps::cli::live {

using kernel::outcome::Result;
using kernel::signal::Frame;

namespace {

/// Longer than the layer takes to see that no tool is in the cut.
constexpr double kPause_s = 2.0;

}  // namespace

Result<std::unique_ptr<RepeatingPort>> RepeatingPort::open(Make make) {
  auto first = make();
  if (!first) {
    return std::unexpected(std::move(first.error()));
  }
  return std::unique_ptr<RepeatingPort>(new RepeatingPort(std::move(make), std::move(*first)));
}

void RepeatingPort::begin_again() {
  Made made = next_.get();
  if (made) {
    present_ = std::move(*made);
    begun_s_ = last_s_;
  }
  next_ = std::async(std::launch::async, make_);
  rested_s_ = 0.0;
}

Result<Frame> RepeatingPort::read() noexcept {
  const bool is_made = next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (present_->finished() && rested_s_ > kPause_s && is_made) {
    begin_again();
  }
  auto frame = present_->read();
  if (frame) {
    frame->time_s += begun_s_;
    for (auto& axis : frame->axis) {
      axis.edge_s += begun_s_;
    }
    frame->cycle = ++cycle_;
    rested_s_ = present_->finished() ? rested_s_ + (frame->time_s - last_s_) : 0.0;
    last_s_ = frame->time_s;
  }
  return frame;
}

}  // namespace steadyrest::apps::cli::live
