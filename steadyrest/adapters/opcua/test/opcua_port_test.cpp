// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/opcua_port.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Machine;
using kernel::machine::Quantity;
using kernel::outcome::Result;

/// A control that shows the heartbeat of the last order, or of another layer's.
class TakingDevice final : public OpcUaPort::Device {
 public:
  struct Shared {
    std::uint32_t taken = 0;  ///< heartbeat of this layer's last order
    std::uint32_t other = 0;  ///< of another layer's, which comes after each; 0: none
    int orders = 0;
    double alive = std::nan("");  ///< what it shows of itself
  };
  TakingDevice(Shared& shared, bool bytes) : shared_(shared), bytes_(bytes) {}

  Result<void> read(Reading& reading) override {
    other_turn_ = !other_turn_;
    const bool other = shared_.other > 0 && other_turn_;
    shared_.other += other ? 1 : 0;
    const std::uint32_t heartbeat = other ? shared_.other : shared_.taken;
    reading.value[static_cast<std::size_t>(Quantity::heartbeat_seen)] =
        bytes_ ? heartbeat_byte(heartbeat) : heartbeat;
    reading.value[static_cast<std::size_t>(Quantity::layer_alive)] = shared_.alive;
    reading.value[static_cast<std::size_t>(Quantity::time_s)] = time_s_ += 0.02;
    return {};
  }
  Result<void> write(const Order& order) override {
    shared_.taken = order.heartbeat;
    ++shared_.orders;
    return {};
  }

 private:
  Shared& shared_;
  bool bytes_;
  bool other_turn_ = false;
  double time_s_ = 0.0;
};

class OneLayer : public testing::TestWithParam<bool> {
 protected:
  OneLayer() {
    Machine machine;
    machine.axes.resize(1);
    machine.opcua.reads = {{.quantity = Quantity::heartbeat_seen, .node = "s=H"}};
    machine.opcua.writes = {
        {.quantity = GetParam() ? Quantity::heartbeat_byte : Quantity::heartbeat, .node = "s=W"}};
    machine.opcua.reply_s = 20.0;
    port_ = OpcUaPort::make(machine, std::make_unique<TakingDevice>(shared_, GetParam())).value();
  }
  /// One reading and one order. False: the reading is refused.
  bool cycle() {
    const auto frame = port_->read();
    const auto written = port_->write({.write = true, .heartbeat = ++heartbeat_});
    unwritten_ = written ? "" : written.error().what;
    words_ = frame ? "" : frame.error().what;
    return frame.has_value();
  }

  TakingDevice::Shared shared_;
  std::unique_ptr<OpcUaPort> port_;
  std::uint64_t heartbeat_ = 0;
  std::string words_;
  std::string unwritten_;
};

TEST_P(OneLayer, GoesOnForEver) {
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(cycle()) << words_;
  }
}

TEST_P(OneLayer, LetsGoForGoodWhereAnotherOnesOrdersAreTaken) {
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(cycle());
  }
  shared_.other = 500;
  int cycles = 0;
  while (cycle()) {
    ASSERT_LT(++cycles, 20);
  }
  EXPECT_EQ(words_, "the control takes orders of another layer: this one has let go of it");
  shared_.other = 0;
  const int orders = shared_.orders;
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(cycle());
  }
  EXPECT_EQ(shared_.orders, orders);
}

TEST_P(OneLayer, OrdersThatTheControlDoesNotTakeAreAFault) {
  shared_.alive = 0.0;
  int cycles = 0;
  while (cycle() && unwritten_.empty()) {
    ASSERT_LT(++cycles, 250);
  }
  EXPECT_EQ(unwritten_, "the control takes none of the layer's orders");
  EXPECT_GE(cycles, 50 + 150) << "a second and three dead men of a second";
  const int orders = shared_.orders;
  cycle();
  cycle();
  EXPECT_GT(shared_.orders, orders) << "they go out all the same";
  shared_.alive = 1.0;
  cycle();
  cycle();
  EXPECT_EQ(unwritten_, "");
}

TEST_P(OneLayer, WhileItOrdersNothingTheControlNeedNotBeAlive) {
  shared_.alive = 0.0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(port_->read());
  }
  cycle();
  EXPECT_EQ(unwritten_, "");
}

INSTANTIATE_TEST_SUITE_P(Mappings, OneLayer, testing::Bool(),
                         [](const auto& of) { return of.param ? "bytes" : "r_parameters"; });

}  // namespace
}  // namespace steadyrest::adapters::opcua
