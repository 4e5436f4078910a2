// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines::testing {

/// What hangs on the lines, in the test's hands.
struct Held {
  Levels inputs;
  Levels outputs;
  std::vector<Levels> written;
  Levels stuck_on;  ///< outputs that stay on
  bool cut = false;
  bool write_fails = false;
  bool reads_back_nothing = false;  ///< outputs are read elsewhere
  std::uint64_t connections = 1;
  int disconnected = 0;  ///< times
  static constexpr double kCycle_s = 0.02;
  double now_s = 0.0;  ///< goes on by a cycle with each reading
};

class HeldWires final : public Wires {
 public:
  explicit HeldWires(Held& held) : held_(held) {}

  kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) override {
    if (held_.cut) {
      return kernel::outcome::unavailable("the link is cut", "mend it");
    }
    held_.now_s += Held::kCycle_s;
    inputs = held_.inputs;
    outputs = held_.reads_back_nothing ? Levels() : held_.outputs;
    return {};
  }
  kernel::outcome::Result<void> write(const Levels& outputs) override {
    if (held_.cut || held_.write_fails) {
      return kernel::outcome::unavailable("the link is cut", "mend it");
    }
    held_.outputs = outputs | held_.stuck_on;
    held_.written.push_back(outputs);
    return {};
  }
  void disconnect() noexcept override { ++held_.disconnected; }
  [[nodiscard]] std::uint64_t connections() const noexcept override { return held_.connections; }
  [[nodiscard]] double now_s() const noexcept override { return held_.now_s; }

 private:
  Held& held_;
};

}  // namespace steadyrest::adapters::lines::testing
