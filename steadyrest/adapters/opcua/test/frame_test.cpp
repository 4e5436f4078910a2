// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/frame.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Quantity;
using kernel::signal::Motion;

Motion motion_by_number(double number) {
  kernel::machine::Machine machine;
  machine.opcua.reads.push_back({.quantity = Quantity::motion_number, .node = "s=G"});
  Reading reading;
  reading.value[static_cast<std::size_t>(Quantity::motion_number)] = number;
  return frame_of(reading, mapped(machine.opcua), machine, nullptr).motion;
}

// G group 1 in the control's order: G0 … G3, CIP, splines, POLY, then the threads.
TEST(Frame, ThreadsAndTapsAreKnownByTheirNumber) {
  EXPECT_EQ(motion_by_number(1), Motion::rapid);
  for (const double feed : {2.0, 3.0, 4.0, 9.0, 15.0, 18.0}) {
    EXPECT_EQ(motion_by_number(feed), Motion::feed) << feed;
  }
  for (const double thread : {10.0, 16.0, 17.0, 20.0, 21.0}) {
    EXPECT_EQ(motion_by_number(thread), Motion::thread) << "G33, G34, G35, G335, G336: " << thread;
  }
  EXPECT_EQ(motion_by_number(11), Motion::tap);
  EXPECT_EQ(motion_by_number(12), Motion::tap);
}

// A control that does not tell the group shows 0: it may be a thread.
TEST(Frame, AnUnknownNumberHoldsTheOverrides) {
  for (const double unknown : {0.0, 22.0, 255.0, -1.0}) {
    EXPECT_EQ(motion_by_number(unknown), Motion::thread) << unknown;
  }
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
