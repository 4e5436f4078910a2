// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/apps/cli/ports/repeating_port.hpp>

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

RepeatingPort::RepeatingPort(Make make, std::unique_ptr<sim::SimulatedMachine> first)
    : make_(std::move(make)),
      present_(std::move(first)),
      maker_([this](const std::stop_token& ends) { make_more(ends); }) {}

RepeatingPort::~RepeatingPort() {
  maker_.request_stop();
  wanted_.release();
}

/// What has finished goes too. What could be made once can be made again.
void RepeatingPort::make_more(const std::stop_token& ends) {
  for (wanted_.acquire(); !ends.stop_requested(); wanted_.acquire()) {
    next_ = make_().value_or(nullptr);
    is_made_.store(next_ != nullptr);
  }
}

void RepeatingPort::begin_again() noexcept {
  std::swap(present_, next_);
  is_made_.store(false);
  wanted_.release();
  begun_s_ = last_s_;
  rested_s_ = 0.0;
}

Result<Frame> RepeatingPort::read() noexcept {
  if (present_->finished() && rested_s_ > kPause_s && is_made_.load()) {
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
