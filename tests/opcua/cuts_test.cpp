// SPDX-License-Identifier: Apache-2.0
// Bridge, link and server are cut at random moments, 100 each. Whatever was on its way, the
// control's side is neutral within its stated time, by its own clock, and never jumps.
#include <cmath>
#include <csignal>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <tests/opcua/live_rig.hpp>
#include <tests/opcua/scene.hpp>

#include <steadyrest/adapters/opcua/control_text.hpp>
#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::opcua {
namespace {

constexpr int kMoments = 100;
constexpr double kHeld = 0.3;      ///< ratio that the layer holds
constexpr double kDelay_s = 0.04;  ///< an order on its way inside the control
constexpr double kInForce = 1e-6;

kernel::machine::Machine scene() {
  auto of = machine();
  of.opcua.reply_s = 5.0;  // a busy computer's pause is no cut
  give_state_folder(of);
  return of;
}

class Cuts : public testing::Test {
 protected:
  Cuts()
      : of_(scene()),
        rig_({.machine = of_,
              .path = path_of("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=900 F2000\nM30\n",
                              of_),
              .order_delay_s = kDelay_s}) {
    const auto table = kernel::override::Table::make(of_.feed_override).value();
    command_.feed_ratio = kHeld;
    command_.feed_code = table.code(table.nearest_step(kHeld).value());
    command_.feed_masks_panel = true;
    command_.write = true;
  }

  bool order(double wait_s = 2.0) {
    ++command_.heartbeat;
    return rig_.write(command_, wait_s);
  }

  /// The layer is in force, for some cycles.
  void hold() {
    std::uniform_int_distribution<int> cycles(2, 6);
    const int more = cycles(random_);
    for (int i = 0; i < more || rig_.control.feed_in_force() > kHeld + kInForce; ++i) {
      ASSERT_LT(i, 400) << "the layer does not come into force";
      rig_.advance();
      ASSERT_TRUE(order());
    }
    ASSERT_NEAR(rig_.control.feed_in_force(), kHeld, kInForce);
    // Not always on a beat of the layer.
    const int periods = std::uniform_int_distribution<int>(0, 4)(random_);
    for (int i = 0; i < periods; ++i) {
      rig_.control.step();
    }
  }

  /// What was on its way may still come; then the control is on its own.
  void expect_neutral(bool server_answers) {
    double from_s = rig_.control.time_s();
    int late = 0;
    const double stated_s = adapters::opcua::neutral_after_s(of_, kHeld) + kDelay_s;
    const double most = of_.opcua.hand_back_1_s * of_.control.interpolator_period_s + kInForce;
    double before = rig_.control.feed_in_force();
    double neutral_s = -1.0;
    for (int i = 0; neutral_s < 0.0; ++i) {
      // The control's clock runs faster here than the sockets: what was on its way counts from its
      // arrival.
      if (server_answers && i % 25 == 0 && rig_.deliver()) {
        from_s = rig_.control.time_s();
        ASSERT_LE(++late, 2);
      }
      rig_.control.step();
      const double now = rig_.control.feed_in_force();
      ASSERT_LE(now - before, most);
      before = now;
      neutral_s = now >= 1.0 - kInForce ? rig_.control.time_s() - from_s : -1.0;
      ASSERT_LE(rig_.control.time_s() - from_s, stated_s + kInForce);
    }
    EXPECT_FALSE(rig_.control.obeys());
    longest_s_ = std::max(longest_s_, neutral_s);
  }

  void tell(const std::string& what) const {
    std::printf("%s: neutral after %.3f s at most, stated %.3f s\n", what.c_str(), longest_s_,
                adapters::opcua::neutral_after_s(of_, kHeld) + kDelay_s);
  }

  /// In the middle of a write, as often as not.
  void some_order() {
    ++command_.heartbeat;
    static_cast<void>(rig_.port->write(command_));
    kernel::link::Event().wait(std::uniform_real_distribution<double>(0.0, 0.004)(random_));
  }

  kernel::machine::Machine of_;
  Rig rig_;
  kernel::signal::Command command_;
  std::mt19937 random_{20};
  double longest_s_ = 0.0;
};

TEST_F(Cuts, OfTheLink) {
  for (int i = 0; i < kMoments && !HasFatalFailure(); ++i) {
    hold();
    some_order();
    rig_.server.way("closed");
    some_order();
    expect_neutral(true);
    rig_.server.way("open");
    rig_.connect();
  }
  tell("link");
}

TEST_F(Cuts, OfTheServer) {
  for (int i = 0; i < kMoments && !HasFatalFailure(); ++i) {
    hold();
    some_order();
    ASSERT_EQ(::kill(rig_.server.process(), SIGSTOP), 0);
    some_order();
    expect_neutral(false);
    ASSERT_EQ(::kill(rig_.server.process(), SIGCONT), 0);
    rig_.connect();
  }
  tell("server");
}

// Most are stopped and go on: the control cannot tell that from a dead one. Every eighth is killed,
// and another takes its place.
TEST_F(Cuts, OfTheBridge) {
  const std::uint64_t starts = rig_.device->starts();
  for (int i = 0; i < kMoments && !HasFatalFailure(); ++i) {
    hold();
    some_order();
    const pid_t bridge = rig_.device->process_id();
    const bool killed = i % 8 == 0;
    ASSERT_EQ(::kill(bridge, killed ? SIGKILL : SIGSTOP), 0);
    some_order();
    expect_neutral(true);
    if (!killed) {
      ::kill(bridge, SIGCONT);
    }
    rig_.connect();
  }
  EXPECT_GE(rig_.device->starts(), starts + kMoments / 8);
  tell("bridge");
}

}  // namespace
}  // namespace steadyrest::opcua
