// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <steadyrest/adapters/lines/lines_port.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/path/commanded_port.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::test::lines {

/// What hangs on the wires: levels that the machine gives and those that it gets.
struct Terminals {
  adapters::lines::Levels inputs;
  adapters::lines::Levels outputs;
  double now_s = 0.0;
};

/// The machine's side of the wires for one kind of link. It is called where the layer reads: first
/// the machine's terminals are set and looked at, then the layer's reading follows.
class Link : public adapters::lines::Wires {
 public:
  virtual void meet(Terminals& terminals) = 0;
};

/// A link without anything between: outputs are what was written last.
class BareLink final : public Link {
 public:
  void meet(Terminals& terminals) override;
  kernel::outcome::Result<void> read(adapters::lines::Levels& inputs,
                                     adapters::lines::Levels& outputs) override;
  kernel::outcome::Result<void> write(const adapters::lines::Levels& outputs) override;
  [[nodiscard]] std::uint64_t connections() const noexcept override { return connections_; }

  bool dead = false;  ///< the module has lost its supply: all outputs are off
  bool cut = false;
  double watchdog_s = 0.0;  ///< outputs drop when they were not written for so long; 0: never

 private:
  adapters::lines::Levels inputs_;
  adapters::lines::Levels outputs_;
  std::uint64_t connections_ = 1;
  double now_s_ = 0.0;
  double written_s_ = 0.0;
};

/// A program on the simulated machine.
[[nodiscard]] std::shared_ptr<const nc::plan::PlannedPath> path_of(
    const kernel::machine::Machine& machine, const std::string& program);

/// 840D with five bits a word, wiring `plc`, feed and spindle, on a link that `open` names.
[[nodiscard]] kernel::machine::Machine wired_840d(double dead_time_s);

/// A layer that reaches the simulated machine by nothing but wires and encoders, with the machine's
/// PLC beyond them. One call is one cycle of the machine; the layer's comes every `cycle_s`. Its
/// orders are on the wires from its next reading on. Used by one thread.
class LineChain {
 public:
  /// `machine` with port lines. The link belongs to the chain; a test failure says what was
  /// refused.
  LineChain(const kernel::machine::Machine& machine,
            const std::shared_ptr<const nc::plan::PlannedPath>& path, std::unique_ptr<Link> link);
  ~LineChain();
  LineChain(const LineChain&) = delete;
  LineChain& operator=(const LineChain&) = delete;

  /// A frame of the machine in, what its PLC makes of the wires out.
  kernel::signal::Command cycle(const kernel::signal::Frame& frame);

  [[nodiscard]] supervisor::Supervisor& layer() { return *layer_; }
  [[nodiscard]] Link& link();
  [[nodiscard]] const Terminals& terminals() const;
  /// What is asked for beside the rooms' own requests.
  supervisor::Supervisor::Requests requests;
  /// Waits until what the layer has ordered is on the wires. Without it a slow computer could put
  /// the last order of a layer on them long after its end, in the machine's time.
  void settle();
  /// The layer's process does not run from here on; the wires stay as they are.
  void kill() { killed_ = true; }
  /// From now on the recorder sends nothing.
  void silence_recorder();
  /// Another process begins.
  void restart();
  [[nodiscard]] std::uint64_t faults() const { return faults_; }
  [[nodiscard]] const std::string& last_fault() const { return last_fault_; }
  [[nodiscard]] std::uint64_t on_path() const { return on_path_; }

 private:
  struct Side;
  void begin();

  kernel::machine::Machine machine_;
  std::unique_ptr<Side> side_;
  std::unique_lock<std::mutex> turn_;  ///< of the test, but for readings
  std::unique_ptr<kernel::port::Port> port_;
  std::shared_ptr<const nc::follow::Route> route_;
  std::unique_ptr<live::CommandedPort> commanded_;
  std::unique_ptr<live::FollowedPort> followed_;
  std::optional<supervisor::Supervisor> layer_;
  kernel::signal::Command plc_;
  bool beat_ = false;
  bool killed_ = false;
  double next_s_ = 0.0;
  std::uint64_t faults_ = 0;
  std::uint64_t on_path_ = 0;
  std::string last_fault_;
};

}  // namespace steadyrest::test::lines
