// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

/// What the supervisor tests are built on: a machine, a supervisor with its inputs, a port.
namespace steadyrest::supervisor::test {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::outcome::Reason;
using machine::Mode;

inline constexpr double kCycle_s = 0.001;
inline constexpr kernel::port::Capability kAll{
    .feed_override = true, .spindle_override = true, .axis_offset = true, .latched_word = true};

inline machine::Machine mill(Mode mode) {
  machine::Machine machine;
  machine.mode = mode;
  machine.axes.resize(4);
  machine.axes[3].rotary = true;
  machine.feed_override = kernel::override::test::feed_840d();
  machine.spindle_override = kernel::override::test::spindle_840d();
  machine.contour.enabled = false;
  return machine;
}

/// A supervisor, its frame and its wishes; each call is one cycle of 1 ms.
class Bench {
 public:
  explicit Bench(Mode mode = Mode::act, const kernel::port::Capability& capability = kAll)
      : Bench(mill(mode), capability) {}
  explicit Bench(const machine::Machine& machine, const kernel::port::Capability& capability = kAll)
      : supervisor(Supervisor::make(machine, capability).value()) {
    frame.motion = signal::Motion::feed;
    frame.feed.panel_code = 0b11010;
    frame.spindle.panel_code = 0b01110;
  }

  signal::Command cycle() {
    frame.time_s += kCycle_s;
    return supervisor.update(
        frame, {.feed = feed, .spindle = spindle, .offset = offset, .path_offset = offset});
  }
  signal::Command cycles(int count) {
    auto command = cycle();
    for (int i = 1; i < count; ++i) {
      command = cycle();
    }
    return command;
  }
  void wish_feed(double ratio) {
    feed = {{.room = signal::Room::contour, .ratio = ratio, .reason = Reason::contour_limit}};
  }
  void wish_spindle(double ratio) {
    spindle = {{.room = signal::Room::chatter, .ratio = ratio, .reason = Reason::contour_limit}};
  }
  void wish_offset(double z_mm) {
    offset = {{.room = signal::Room::thermal, .reason = Reason::contour_limit}};
    offset[0].offset_mm[2] = z_mm;
  }

  Supervisor supervisor;
  signal::Frame frame;
  std::vector<signal::FeedRequest> feed;
  std::vector<signal::SpindleRequest> spindle;
  std::vector<signal::OffsetRequest> offset;
};

class FakePort final : public kernel::port::Port {
 public:
  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return kAll; }
  kernel::outcome::Result<signal::Frame> read() noexcept override {
    if (lost) {
      return std::unexpected(kernel::outcome::Refusal{
          .kind = kernel::outcome::Kind::unavailable, .file = {}, .what = "lost", .to_do = {}});
    }
    frame.time_s += kCycle_s;
    return frame;
  }
  kernel::outcome::Result<void> write(const signal::Command& command) noexcept override {
    if (deaf) {
      return std::unexpected(kernel::outcome::Refusal{});
    }
    written.push_back(command);
    return {};
  }

  bool lost = false;
  bool deaf = false;
  signal::Frame frame;
  std::vector<signal::Command> written;
};

/// Words go over separate wires, which are read every 20 ms.
inline kernel::machine::Machine wired(Mode mode, bool may_exceed = false) {
  auto machine = mill(mode);
  for (auto* table : {&machine.feed_override, &machine.spindle_override}) {
    table->latched_word = false;
    table->scan_period_s = 0.02;
    table->layer_may_exceed_panel = may_exceed;
  }
  return machine;
}

}  // namespace steadyrest::supervisor::test
