// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/other_client.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::machine::Wiring;
using kernel::outcome::Result;

/// Wires that somebody else uses; `each` is called before each reading.
class SharedWires final : public Wires {
 public:
  explicit SharedWires(std::function<void(SharedWires&)> each) : each_(std::move(each)) {}

  Result<void> read(Levels& inputs_now, Levels& outputs_now) override {
    now += 0.01;
    each_(*this);
    inputs_now = inputs;
    outputs_now = outputs;
    return {};
  }
  Result<void> write(const Levels& /*outputs*/) override {
    ADD_FAILURE() << "who looks writes nothing";
    return {};
  }
  [[nodiscard]] std::uint64_t connections() const noexcept override { return 1; }
  [[nodiscard]] double now_s() const noexcept override { return now; }

  Levels inputs;
  Levels outputs;
  double now = 0.0;

 private:
  std::function<void(SharedWires&)> each_;
};

Lines watched_lines(Wiring wiring) {
  Lines lines;
  lines.wiring = wiring;
  lines.cycle_s = 0.1;
  lines.feed.panel = {0, 1, 2};
  lines.feed.out = {0, 1, 2};
  lines.feed.mask = 3;
  lines.heartbeat = 4;
  return lines;
}

std::string seen(Wiring wiring, std::function<void(SharedWires&)> each) {
  SharedWires wires(std::move(each));
  return other_client(wires, watched_lines(wiring), [] {}).value();
}

TEST(OtherClient, NobodyIsSeenOnQuietOutputs) {
  for (const Wiring wiring : {Wiring::relay, Wiring::plc, Wiring::through}) {
    EXPECT_EQ(seen(wiring, [](auto& wires) { wires.outputs = Levels(0b101); }), "");
  }
}

TEST(OtherClient, OutputsOfOthersOnTheSameModuleDoNotCount) {
  EXPECT_EQ(seen(Wiring::plc, [](auto& wires) { wires.outputs.flip(9); }), "");
}

TEST(OtherClient, AMaskThatStaysIsALayerWhereNoHeartbeatTells) {
  const auto mask = [](auto& wires) { wires.outputs.set(3); };
  EXPECT_EQ(seen(Wiring::relay, mask), "") << "its heartbeat does not change";
  SharedWires wires(mask);
  Lines lines = watched_lines(Wiring::relay);
  lines.heartbeat = kernel::machine::kNoLine;
  EXPECT_EQ(other_client(wires, lines, [] {}).value(),
            "output 3, a mask, is on: a layer acts on this module");
}

// A service starts the layer again at once after it has died.
TEST(OtherClient, AModulesWatchdogIsWaitedFor) {
  for (const double died_s : {0.0, 0.8}) {
    for (const bool beats : {true, false}) {
      // The word stays, the mask drops: as modules with safe values do.
      SharedWires wires(
          [&](auto& of) { of.outputs = Levels(of.now < died_s ? 0b11101 : 0b00111); });
      Lines lines = watched_lines(Wiring::relay);
      lines.heartbeat = beats ? lines.heartbeat : kernel::machine::kNoLine;
      lines.watchdog_s = 0.5;
      EXPECT_EQ(other_client(wires, lines, [] {}).value(), "") << died_s;
    }
  }
}

TEST(OtherClient, AHeartbeatOfFourCyclesIsSeen) {
  const auto beats = [](auto& wires) { wires.outputs[4] = wires.now > 0.35; };
  EXPECT_EQ(seen(Wiring::plc, beats),
            "output 4 changes though this program writes nothing: a layer acts on this module");
  EXPECT_NE(seen(Wiring::through, beats), "");
}

TEST(OtherClient, WithoutAHeartbeatAnyOutputTells) {
  SharedWires wires([](auto& of) { of.outputs = Levels(of.now > 0.2 ? 0b011 : 0b001); });
  Lines lines = watched_lines(Wiring::relay);
  lines.heartbeat = kernel::machine::kNoLine;
  EXPECT_EQ(other_client(wires, lines, [] {}).value(),
            "output 1 changes though this program writes nothing: a layer acts on this module");
}

TEST(OtherClient, WithThroughAPanelThatTurnsExcusesTheWord) {
  SharedWires wires([](auto& of) { of.inputs = of.outputs = Levels(of.now > 0.2 ? 3 : 1); });
  Lines lines = watched_lines(Wiring::through);
  lines.heartbeat = kernel::machine::kNoLine;
  EXPECT_EQ(other_client(wires, lines, [] {}).value(), "");
}

TEST(OtherClient, ALinkThatIsLostIsRefused) {
  class Lost final : public Wires {
   public:
    Result<void> read(Levels& /*inputs*/, Levels& /*outputs*/) override {
      return kernel::outcome::unavailable("the link is cut", "mend it");
    }
    Result<void> write(const Levels& /*outputs*/) override { return {}; }
    [[nodiscard]] std::uint64_t connections() const noexcept override { return 0; }
  };
  Lost wires;
  const auto refused = other_client(wires, watched_lines(Wiring::plc), [] {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "the link is cut");
}

}  // namespace
}  // namespace steadyrest::adapters::lines
