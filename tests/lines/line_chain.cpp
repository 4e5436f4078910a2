// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// The exchange's thread writes an order as soon as it can, beside the test. A lock makes them take
// turns: that thread touches wires and encoders only while the test waits for a reading.
namespace steadyrest::test::lines {

using adapters::lines::CounterSample;
using adapters::lines::EncoderReading;
using adapters::lines::EncoderSource;
using adapters::lines::Levels;
using adapters::lines::put_word;
using adapters::lines::RecorderSample;
using adapters::lines::RecorderTrack;
using adapters::lines::word_of;
using kernel::machine::Machine;
using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;

namespace {

constexpr std::uint32_t kClock_hz = 10'000'000;
constexpr double kPatient_s = 20.0;  ///< a reading may take so long: the machine waits meanwhile

std::uint32_t ticks(double time_s) {
  return static_cast<std::uint32_t>(std::llround(time_s * kClock_hz));
}

}  // namespace

void BareLink::meet(Terminals& terminals) {
  now_s_ = terminals.now_s;
  inputs_ = terminals.inputs;
  if (dead || (watchdog_s > 0.0 && now_s_ - written_s_ > watchdog_s)) {
    outputs_.reset();
  }
  terminals.outputs = outputs_;
}

Result<void> BareLink::read(Levels& inputs, Levels& outputs) {
  if (cut) {
    ++connections_;
    return kernel::outcome::unavailable("the link is cut", "mend it");
  }
  inputs = inputs_;
  outputs = outputs_;
  return {};
}

Result<void> BareLink::write(const Levels& outputs) {
  if (cut) {
    return kernel::outcome::unavailable("the link is cut", "mend it");
  }
  outputs_ = outputs;
  written_s_ = now_s_;
  return {};
}

std::shared_ptr<const nc::plan::PlannedPath> path_of(const Machine& machine,
                                                     const std::string& program) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  return std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(program, config, machine, "program.mpf").value());
}

Machine wired_840d(double dead_time_s) {
  Machine machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d.toml").value();
  machine.port = kernel::machine::PortKind::lines;
  machine.mode = kernel::machine::Mode::act;
  for (auto* table : {&machine.feed_override, &machine.rapid_override, &machine.spindle_override}) {
    table->dead_time_s = dead_time_s;
  }
  auto& lines = machine.lines;
  lines.wiring = kernel::machine::Wiring::plc;
  lines.cycle_s = machine.control.interpolator_period_s;
  lines.reply_s = kPatient_s;
  lines.feed = {.panel = {0, 1, 2, 3, 4}, .out = {0, 1, 2, 3, 4}, .mask = 5};
  lines.spindle = {.panel = {5, 6, 7, 8, 9}, .out = {6, 7, 8, 9, 10}, .mask = 11};
  lines.heartbeat = 12;
  lines.running = 10;
  lines.modulate = 11;
  lines.locked = 12;
  return machine;
}

/// Wires and encoders of the layer's side, the machine behind them.
struct LineChain::Side {
  std::mutex turn;  ///< whose turn it is to touch the others
  std::unique_ptr<Link> link;
  Terminals terminals;
  RecorderSample sample;
  bool recorder_silent = false;

  class LinkWires final : public adapters::lines::Wires {
   public:
    explicit LinkWires(Side& side) : side_(side) {}
    Result<void> read(Levels& inputs, Levels& outputs) override {
      const std::scoped_lock lock(side_.turn);
      now_s_ = side_.terminals.now_s;
      return side_.link->read(inputs, outputs);
    }
    Result<void> write(const Levels& outputs) override {
      const std::scoped_lock lock(side_.turn);
      return side_.link->write(outputs);
    }
    [[nodiscard]] std::uint64_t connections() const noexcept override {
      return side_.link->connections();
    }
    [[nodiscard]] double now_s() const noexcept override { return now_s_; }

   private:
    Side& side_;
    double now_s_ = 0.0;
  };

  class Encoders final : public EncoderSource {
   public:
    explicit Encoders(Side& side) : side_(side) {}
    Result<EncoderReading> next() override {
      const std::scoped_lock lock(side_.turn);
      if (side_.recorder_silent) {
        return kernel::outcome::unavailable("the recorder sends nothing", "see its cable");
      }
      return track_.take(side_.sample);
    }

   private:
    Side& side_;
    RecorderTrack track_;
  };

  /// Gives the turn away while it reads, and when it ends.
  class TurnPort final : public kernel::port::Port {
   public:
    TurnPort(std::unique_ptr<Port> port, std::unique_lock<std::mutex>& turn)
        : port_(std::move(port)), turn_(turn) {}
    TurnPort(const TurnPort&) = delete;
    TurnPort& operator=(const TurnPort&) = delete;
    ~TurnPort() override {
      turn_.unlock();
      port_.reset();
      turn_.lock();
    }
    [[nodiscard]] kernel::port::Capability capability() const noexcept override {
      return port_->capability();
    }
    Result<Frame> read() noexcept override {
      turn_.unlock();
      auto got = port_->read();
      turn_.lock();
      return got;
    }
    Result<void> write(const Command& command) noexcept override { return port_->write(command); }

   private:
    std::unique_ptr<Port> port_;
    std::unique_lock<std::mutex>& turn_;
  };
};

LineChain::LineChain(const Machine& machine,
                     const std::shared_ptr<const nc::plan::PlannedPath>& path,
                     std::unique_ptr<Link> link)
    : machine_(machine), side_(std::make_unique<Side>()), turn_(side_->turn) {
  side_->link = std::move(link);
  // The recorder counts from where the axes stand at the start.
  machine_.recorder.start_mm = {path->segments.front().start_mm.begin(),
                                path->segments.front().start_mm.end()};
  route_ = std::make_shared<const nc::follow::Route>(path->segments);
  begin();
}

LineChain::~LineChain() = default;

void LineChain::begin() {
  auto port = adapters::lines::LinesPort::make(machine_, std::make_unique<Side::LinkWires>(*side_),
                                               std::make_unique<Side::Encoders>(*side_));
  if (!port) {
    ADD_FAILURE() << kernel::outcome::text(port.error());
    return;
  }
  port_ = std::make_unique<Side::TurnPort>(std::move(*port), turn_);
  commanded_ = live::CommandedPort::make(*port_, machine_).value();
  followed_ = std::make_unique<live::FollowedPort>(
      *commanded_,
      live::FollowedPort::Config{.locator = {.near_mm = 0.1, .far_mm = 2.0, .without_lines = true},
                                 .estimated = true});
  followed_->offer(route_);
  layer_.emplace(supervisor::Supervisor::make(machine_, followed_->capability()).value());
}

void LineChain::silence_recorder() {
  settle();
  side_->recorder_silent = true;
}

void LineChain::settle() {
  // A reading comes after the order.
  EXPECT_TRUE(port_->read());
}

void LineChain::restart() {
  killed_ = false;
  begin();
}

Link& LineChain::link() {
  return *side_->link;
}

const Terminals& LineChain::terminals() const {
  return side_->terminals;
}

Command LineChain::cycle(const Frame& frame) {
  const auto& lines = machine_.lines;
  Terminals& wires = side_->terminals;
  wires.now_s = frame.time_s;
  put_word(frame.feed.panel_code, lines.feed.panel, false, wires.inputs);
  put_word(frame.spindle.panel_code, lines.spindle.panel, false, wires.inputs);
  wires.inputs[lines.running] = true;
  wires.inputs[lines.modulate] = frame.speed_modulation;
  wires.inputs[lines.locked] = kernel::signal::is_locked(frame.motion);
  auto& sample = side_->sample;
  ++sample.sequence;
  sample.clock_hz = kClock_hz;
  sample.ticks = ticks(frame.time_s);
  sample.counters = 3;
  for (std::size_t i = 0; i < sample.counters; ++i) {
    const auto& axis = frame.axis.at(i);
    CounterSample& counter = sample.counter.at(i);
    counter.count = static_cast<std::int32_t>(axis.count);
    if (std::isfinite(axis.edge_s)) {
      counter.edge_ticks = ticks(axis.edge_s);
      counter.direction = axis.edge_direction;
    }
  }
  side_->link->meet(wires);
  if (!killed_ && frame.time_s >= next_s_ - 1e-9) {
    next_s_ = frame.time_s + lines.cycle_s;
    if (auto done = layer_->cycle(*followed_, requests); !done) {
      ++faults_;
      last_fault_ = kernel::outcome::text(done.error());
    }
    on_path_ += followed_->place() == nc::follow::Place::on_path ? 1 : 0;
  }
  // The PLC looks at the outputs as they were before this cycle's order.
  const bool beat = wires.outputs[lines.heartbeat];
  plc_.heartbeat += beat != beat_ ? 1 : 0;
  beat_ = beat;
  plc_.feed_code = word_of(wires.outputs, lines.feed.out, false);
  plc_.feed_masks_panel = wires.outputs[lines.feed.mask];
  plc_.spindle_code = word_of(wires.outputs, lines.spindle.out, false);
  plc_.spindle_masks_panel = wires.outputs[lines.spindle.mask];
  plc_.write = true;
  return plc_;
}

}  // namespace steadyrest::test::lines
