// SPDX-License-Identifier: Apache-2.0
// The control's side alone, without any link: the shipped text on the simulated machine.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tests/opcua/control_side.hpp>
#include <tests/opcua/scene.hpp>

#include <steadyrest/adapters/opcua/control_text.hpp>
#include <steadyrest/adapters/opcua/frame.hpp>
#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::opcua {
namespace {

using adapters::opcua::NodePlan;
using adapters::opcua::Order;

/// Writes orders as the port does.
class Layer {
 public:
  Layer(ControlSide& control, const kernel::machine::Machine& of)
      : control_(control), plan_(of.opcua) {}
  void write(Order order) {
    order.heartbeat = ++heartbeat_;
    const auto values = plan_.encode(order);
    for (std::size_t i = 0; i < values.size(); ++i) {
      control_.write(plan_.writes()[i].id, values[i]);
    }
  }
  void feed(double percent) {
    Order order;
    order.masks_feed = true;
    order.feed_percent = percent;
    write(order);
  }

 private:
  ControlSide& control_;
  NodePlan plan_;
  std::uint32_t heartbeat_ = 0;
};

class DeadMan : public testing::Test {
 protected:
  void run(double seconds, double feed_percent = NAN) {
    const double until_s = control.time_s() + seconds;
    for (int i = 0; control.time_s() < until_s - 1e-9; ++i) {
      if (!std::isnan(feed_percent) && i % 5 == 0) {
        layer.feed(feed_percent);
      }
      control.step();
    }
  }

  kernel::machine::Machine of = machine();
  ControlSide control{
      {.machine = of,
       .path = path_of("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=90 F2000\nM30\n", of)}};
  Layer layer{control, of};
};

TEST_F(DeadMan, TheLowerOfLayerAndPanelIsInForce) {
  run(0.3, 40.0);
  EXPECT_NEAR(control.feed_in_force(), 0.4, 1e-9);
  EXPECT_TRUE(control.obeys());
}

TEST_F(DeadMan, WithoutOrdersTheFeedIsThePanelsWithinTheStatedTimeAndNeverJumps) {
  run(0.5, 10.0);
  double before = control.feed_in_force();
  ASSERT_NEAR(before, 0.1, 1e-9);
  const double from_s = control.time_s();
  double neutral_s = -1.0;
  const double most = of.opcua.hand_back_1_s * of.control.interpolator_period_s + 1e-9;
  for (int i = 0; i < 400; ++i) {
    control.step();
    ASSERT_LE(control.feed_in_force() - before, most);
    before = control.feed_in_force();
    if (neutral_s < 0.0 && before >= 1.0 - 1e-9) {
      neutral_s = control.time_s() - from_s;
    }
  }
  // Both bounds: neither late nor before a layer could be late.
  const double stated_s = adapters::opcua::neutral_after_s(of, 0.1);
  EXPECT_LE(neutral_s, stated_s);
  EXPECT_GE(neutral_s, stated_s - 0.05);
  EXPECT_FALSE(control.obeys());
}

// A layer, a bridge or a network that is late by anything below the dead man, again and again.
TEST_F(DeadMan, LateOrdersNeverRaiseFeedOrSpindleInTheCut) {
  Order order;
  order.masks_feed = order.masks_spindle = order.has_offsets = true;
  order.feed_percent = 30.0;
  order.spindle_percent = 80.0;
  order.offset_mm[0] = 0.001;
  const double period_s = of.control.interpolator_period_s;
  const auto cycles = [&](double time_s) { return static_cast<int>(std::ceil(time_s / period_s)); };
  for (int i = 0; i < cycles(0.5); ++i) {
    layer.write(order);
    control.step();
  }
  ASSERT_NEAR(control.feed_in_force(), 0.3, 1e-9);
  const double offset_mm = control.offset_mm(0);
  ASSERT_NEAR(offset_mm, 0.001, 1e-9);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any_s(0.0, of.opcua.dead_man_s - period_s);
  for (const double late_s :
       {0.001, 0.02, 0.1, 0.19, 0.2, 0.21, 0.5, 0.9, of.opcua.dead_man_s - 2.0 * period_s,
        any_s(random), any_s(random), any_s(random), any_s(random), any_s(random), any_s(random)}) {
    for (int i = 0; i < cycles(late_s); ++i) {
      control.step();
      ASSERT_LE(control.feed_in_force(), 0.3 + 1e-9) << late_s << " s late, cycle " << i;
      ASSERT_NEAR(control.read("$AA_TOTAL_OVR[S1]"), 80.0, 1e-6) << late_s;
      ASSERT_EQ(control.offset_mm(0), offset_mm);
      ASSERT_TRUE(control.obeys());
    }
    layer.write(order);
    control.step();
    ASSERT_NEAR(control.feed_in_force(), 0.3, 1e-9) << "it goes on without a jump";
  }
}

TEST_F(DeadMan, ResetInTheCutHandsBackByTheRampToo) {
  run(0.5, 10.0);
  double before = control.feed_in_force();
  ASSERT_NEAR(before, 0.1, 1e-9);
  control.reset();
  const double most = of.opcua.hand_back_1_s * of.control.interpolator_period_s + 1e-9;
  const double from_s = control.time_s();
  while (before < 1.0 - 1e-9) {
    control.step();
    ASSERT_FALSE(control.obeys()) << "no order has come since";
    ASSERT_LE(control.feed_in_force() - before, most);
    before = control.feed_in_force();
    ASSERT_LE(control.time_s() - from_s, adapters::opcua::neutral_after_s(of, 0.1));
  }
}

TEST_F(DeadMan, ALayerThatDiesAtARandomMomentLeavesNothingBehind) {
  std::mt19937 random(7);
  double longest_s = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double held = std::uniform_real_distribution<double>(0.0, 1.0)(random);
    run(std::uniform_real_distribution<double>(0.1, 0.4)(random), 100.0 * held);
    ASSERT_NEAR(control.feed_in_force(), held, 1e-6);
    const double from_s = control.time_s();
    while (control.feed_in_force() < 1.0 - 1e-9 || control.obeys()) {
      control.step();
      ASSERT_LE(control.time_s() - from_s, adapters::opcua::neutral_after_s(of, held) + 1e-6);
    }
    longest_s = std::max(longest_s, control.time_s() - from_s);
  }
  EXPECT_GT(longest_s, 0.5) << "some were held low";
}

TEST_F(DeadMan, AfterTheHandBackThePanelTurnsFreely) {
  run(0.3, 10.0);
  run(2.0);
  const double before = control.feed_in_force();
  EXPECT_EQ(before, 1.0);
  EXPECT_EQ(control.r(static_cast<int>(of.opcua.first_work) + 8), 100.0);
}

TEST_F(DeadMan, ATornOrAForeignOrderIsNotTaken) {
  run(0.3, 50.0);
  const int order = static_cast<int>(of.opcua.first_order);
  for (const double feed : {-1.0, 121.0, 1e9, -1e300}) {
    control.r(order + 4) = feed;
    control.r(order) = control.r(order) + 1;
    control.r(order + 9) = control.r(order);
    control.step();
    EXPECT_NEAR(control.feed_in_force(), 0.5, 1e-9) << feed;
  }
  control.r(order + 4) = 80.0;
  control.r(order) = 77.0;  // the first number without the last: written in parts
  control.step();
  EXPECT_NEAR(control.feed_in_force(), 0.5, 1e-9);
}

// 1.11 / 0.01 is a little more than 111.
TEST_F(DeadMan, EveryValueOfTheEnvelopeIsTaken) {
  const auto path = circles(of);
  for (int percent = 1; percent <= 200; ++percent) {
    auto wide = of;
    wide.envelope.max_feed_ratio = percent / 100.0;
    wide.envelope.min_spindle_ratio = wide.envelope.max_feed_ratio;
    wide.envelope.max_spindle_ratio = wide.envelope.max_feed_ratio;
    ControlSide one({.machine = wide, .path = path});
    kernel::signal::Command command;
    command.feed_masks_panel = command.spindle_masks_panel = true;
    command.feed_ratio = command.spindle_ratio = percent / 100.0;
    command.offset_mm[0] = wide.envelope.max_offset_mm;
    Layer(one, wide).write(adapters::opcua::order_of(command, wide));
    one.step();
    ASSERT_TRUE(one.obeys()) << percent;
  }
}

TEST_F(DeadMan, AnOffsetBeyondTheEnvelopeIsNotTaken) {
  Order order;
  order.has_offsets = true;
  for (const double offset : {5.0, -5.0, 1e300}) {
    order.offset_mm[1] = offset;
    layer.write(order);
    control.step();
    ASSERT_FALSE(control.obeys()) << offset;
    ASSERT_EQ(control.offset_mm(1), 0.0);
  }
}

TEST_F(DeadMan, AnOffsetThatIsNoNumberIsNotTaken) {
  const int first = static_cast<int>(of.opcua.first_order);
  const int last = first + static_cast<int>(kernel::machine::order_count(3)) - 1;
  control.r(first + 1) = control.r(first + 2) = control.r(first + 3) = 1.0;
  control.r(first + 4) = control.r(first + 5) = 90.0;
  control.r(first) = control.r(last) = 1.0;
  control.step();
  ASSERT_TRUE(control.obeys());
  run(of.opcua.dead_man_s + 0.1);
  control.r(first + 7) = std::numeric_limits<double>::quiet_NaN();
  control.r(first) = control.r(last) = 2.0;
  control.step();
  EXPECT_FALSE(control.obeys());
}

TEST_F(DeadMan, AForeignOffsetStaysWithinTheEnvelope) {
  const int goal = static_cast<int>(of.opcua.first_work) + 12;
  Order order;
  for (int i = 0; i < 1500; ++i) {
    layer.write(order);  // without offsets
    control.r(goal) = 5.0;
    control.step();
    ASSERT_LE(control.offset_mm(0), of.envelope.max_offset_mm + 1e-5);
  }
}

// Whatever a program or an operator writes into the parameters that the actions work in.
TEST_F(DeadMan, ForeignValuesLeaveNothingBehindAndNothingOutsideOfTheEnvelope) {
  const int first = static_cast<int>(of.opcua.first_work);
  const double most_s = adapters::opcua::neutral_after_s(of, 0.0) + of.opcua.dead_man_s + 0.1;
  for (int i = 0; i < static_cast<int>(kernel::machine::work_count(3)); ++i) {
    for (const double foreign : {-1e9, -1.0, 0.0, 1e9}) {
      Order order;
      order.masks_feed = order.masks_spindle = order.has_offsets = true;
      order.feed_percent = order.spindle_percent = 80.0;
      layer.write(order);
      control.step();
      ASSERT_TRUE(control.obeys());
      control.r(first + i) = foreign;
      for (const double until_s = control.time_s() + most_s; control.time_s() < until_s;) {
        control.step();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          ASSERT_LE(std::abs(control.offset_mm(axis)), of.envelope.max_offset_mm + 1e-5) << i;
        }
        ASSERT_GE(control.feed_in_force(), 0.0);
        ASSERT_GE(control.read("$AA_TOTAL_OVR[S1]"), 100.0 * of.envelope.min_spindle_ratio - 1e-4);
      }
      ASSERT_FALSE(control.obeys()) << i << " " << foreign;
      ASSERT_NEAR(control.feed_in_force(), 1.0, 1e-9) << i << " " << foreign;
      ASSERT_NEAR(control.read("$AA_TOTAL_OVR[S1]"), 100.0, 1e-6) << i << " " << foreign;
    }
  }
}

TEST_F(DeadMan, NoOrderIsTakenInABlockSearch) {
  run(0.1, 40.0);
  control.searches = true;
  run(adapters::opcua::neutral_after_s(of, 0.4), 40.0);
  EXPECT_FALSE(control.obeys());
  EXPECT_NEAR(control.feed_in_force(), 1.0, 1e-9);
  control.searches = false;
  run(0.1, 40.0);
  EXPECT_NEAR(control.feed_in_force(), 0.4, 1e-9);
}

TEST_F(DeadMan, DeletedParametersDoNotStopTheSpindle) {
  Order order;
  order.masks_spindle = true;
  order.spindle_percent = 100.0 * of.envelope.min_spindle_ratio;
  layer.write(order);
  control.step();
  for (std::size_t i = of.opcua.first_sample;
       i < of.opcua.first_work + kernel::machine::work_count(3); ++i) {
    control.r(static_cast<int>(i)) = 0.0;
  }
  control.step();
  EXPECT_GE(control.read("$AA_TOTAL_OVR[S1]"), order.spindle_percent - 1e-6);
}

TEST_F(DeadMan, TheFeedReturnsNoFasterThanTheSpindle) {
  auto slow = machine();
  slow.envelope.spindle_slew_1_s = 0.5;
  ControlSide one({.machine = slow, .path = circles(slow)});
  Layer dying(one, slow);
  Order order;
  order.masks_feed = order.masks_spindle = true;
  order.feed_percent = order.spindle_percent = 80.0;
  dying.write(order);
  const double most_s = adapters::opcua::neutral_after_s(slow, 0.8);
  EXPECT_NEAR(most_s, 1.0 + 0.2 / 0.5 + 2.0 * slow.control.interpolator_period_s, 1e-9);
  const double from_s = one.time_s();
  do {
    one.step();
    ASSERT_LE(100.0 * one.feed_in_force(), one.read("$AA_TOTAL_OVR[S1]") + 1e-6);
    ASSERT_LE(one.time_s() - from_s, most_s + 1e-6);
  } while (one.feed_in_force() < 1.0 - 1e-9);
}

TEST_F(DeadMan, OffsetsMoveSlowlyFreezeInTheCutAndGoWhenTheProgramHasEnded) {
  Order order;
  order.has_offsets = true;
  order.offset_mm[1] = of.envelope.max_offset_mm;
  double before = 0.0;
  const double step = of.envelope.offset_slew_mm_s * of.control.interpolator_period_s;
  for (int i = 0; i < 1500; ++i) {
    if (i % 5 == 0) {
      layer.write(order);
    }
    control.step();
    ASSERT_LE(std::abs(control.offset_mm(1) - before), 2.0 * step + 1e-12);
    before = control.offset_mm(1);
  }
  EXPECT_NEAR(before, of.envelope.max_offset_mm, 1e-9);
  run(2.0);
  EXPECT_FALSE(control.obeys());
  EXPECT_NEAR(control.offset_mm(1), before, 2.0 * step + 1e-12) << "frozen in the cut";
  while (!control.finished()) {
    control.step();
  }
  run(2.0 * of.envelope.max_offset_mm / of.envelope.offset_slew_mm_s);
  EXPECT_EQ(control.offset_mm(1), 0.0);
}

TEST(DeadManPanel, ThePanelWinsWhileTheLayerIsLate) {
  const auto of = machine();
  const auto table = kernel::override::Table::make(of.feed_override).value();
  const auto code = [&](double ratio) { return table.code(table.nearest_step(ratio).value()); };
  ControlSide control(
      {.machine = of,
       .path = circles(of),
       .operator_actions = {
           {.time_s = 0.3, .act = sim::OperatorAct::turn_feed, .code = code(0.1)},
           {.time_s = 0.5, .act = sim::OperatorAct::turn_feed, .code = table.code(0)},
           {.time_s = 0.7, .act = sim::OperatorAct::turn_feed, .code = code(1.2)}}});
  Layer layer(control, of);
  layer.feed(30.0);
  const double from_s = control.time_s();
  double before = control.panel_ratio();
  while (control.time_s() < from_s + of.opcua.dead_man_s - 0.01) {
    control.step();
    // The actions see the panel of the cycle before.
    const bool turns =
        std::abs(control.panel_ratio() - std::exchange(before, control.panel_ratio())) > 0.0;
    ASSERT_LE(control.feed_in_force(), control.panel_ratio());
    if (turns) {
      continue;
    }
    ASSERT_NEAR(control.feed_in_force(), std::min(0.3, control.panel_ratio()), 1e-9)
        << control.time_s();
  }
  EXPECT_GT(control.panel_ratio(), 1.1);
}

TEST(DeadManPanel, ThePanelAtZeroStopsWhateverTheLayerWants) {
  const auto of = machine();
  const auto table = kernel::override::Table::make(of.feed_override).value();
  ControlSide control(
      {.machine = of,
       .path = circles(of),
       .operator_actions = {
           {.time_s = 0.3, .act = sim::OperatorAct::turn_feed, .code = table.code(0)}}});
  Layer layer(control, of);
  for (int i = 0; i < 250; ++i) {
    layer.feed(100.0);
    control.step();
    if (control.time_s() > 0.32) {
      ASSERT_EQ(control.feed_in_force(), 0.0);
    }
  }
  EXPECT_EQ(control.frame().path_speed_mm_s, 0.0);
}

}  // namespace
}  // namespace steadyrest::opcua
