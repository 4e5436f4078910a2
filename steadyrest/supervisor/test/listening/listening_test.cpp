// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/supervisor/test/listening/chattering_cut.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Machine;
using kernel::machine::Mode;
using test::ChatteringCut;

Supervisor layer_of(const Machine& machine, bool acts = true) {
  auto layer = Supervisor::make(machine, ChatteringCut::kPort).value();
  layer.set_mode(Mode::act);
  EXPECT_TRUE(layer.listen(ChatteringCut::listener(acts)));
  return layer;
}

double run(Supervisor& layer, ChatteringCut& cut, double seconds) {
  double ratio = 1.0;
  for (int i = 0; i < static_cast<int>(seconds / ChatteringCut::kCycle_s); ++i) {
    const auto command = layer.update(cut.next());
    ratio = command.spindle_ratio;
    cut.obey(command);
  }
  return ratio;
}

TEST(Listening, TakesTheBetterStep) {
  ChatteringCut cut;
  auto layer = layer_of(ChatteringCut::machine());
  EXPECT_DOUBLE_EQ(run(layer, cut, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(run(layer, cut, 4.0), 0.9);
  EXPECT_FALSE(layer.estimates().heard->chatter);
}

TEST(Listening, OneThatDoesNotActHearsAndLeavesTheModulatorAlone) {
  Machine machine = ChatteringCut::machine();
  machine.chatter.mean_ratio = 0.95;  // of the machine file: the cut is loud at it too
  ChatteringCut cut;
  auto layer = layer_of(machine, false);
  EXPECT_NEAR(run(layer, cut, 3.0), 0.95, 0.051);
  machine.chatter.enabled = false;
  ChatteringCut loud;
  auto other = layer_of(machine, false);
  EXPECT_DOUBLE_EQ(run(other, loud, 3.0), 1.0);
  ASSERT_TRUE(other.estimates().heard);
  EXPECT_TRUE(other.estimates().heard->chatter);
  EXPECT_EQ(other.estimates().heard->request.ratio, 1.0);
}

TEST(Listening, OneThatActsNeedsTheChatterRoom) {
  Machine machine = ChatteringCut::machine();
  machine.chatter.enabled = false;
  auto layer = Supervisor::make(machine, ChatteringCut::kPort).value();
  EXPECT_FALSE(layer.listen(ChatteringCut::listener()));
  EXPECT_TRUE(layer.listen(ChatteringCut::listener(false)));
}

// Going back to the speed that chattered would leave a mark in the part.
TEST(Listening, TheBetterStepOutlivesAnotherMachineFile) {
  for (const bool kept_room : {true, false}) {
    const Machine running = ChatteringCut::machine();
    Machine wanted = running;
    wanted.contour.limit_mm *= 2.0;
    if (!kept_room) {
      wanted.envelope.max_feed_ratio *= 0.9;
    }
    ASSERT_EQ(kept(running, wanted).chatter, kept_room);
    ChatteringCut cut;
    auto layer = layer_of(running);
    ASSERT_DOUBLE_EQ(run(layer, cut, 4.0), 0.9);
    auto next = layer_of(wanted);
    {
      const kernel::rt::testing::AllocationGuard guard;
      next.take_over(layer, kept(running, wanted));
      EXPECT_EQ(guard.allocations(), 0U);
    }
    for (int i = 0; i < 1000; ++i) {
      const auto command = next.update(cut.next());
      ASSERT_DOUBLE_EQ(command.spindle_ratio, 0.9) << i;
      cut.obey(command);
    }
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
