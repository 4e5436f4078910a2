// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/node_check.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Quantity;

class ValueFaults : public testing::Test {
 protected:
  ValueFaults() {
    machine_.opcua.mapping = "map.toml";
    machine_.axes.resize(1);
    machine_.axes[0].min_au = -100.0;
    machine_.axes[0].max_au = 400.0;
    machine_.feed_override.ratio = {0.0, 1.2};
  }
  void show(Quantity quantity, double value) {
    reading_.value[static_cast<std::size_t>(quantity)] = value;
  }
  void show_x(double command_mm) {
    reading_.axis[0][Reading::index_of(Quantity::command_mm)] = command_mm;
  }
  [[nodiscard]] std::string faults() const {
    std::string out;
    for (const auto& all :
         {override_faults(reading_, machine_), position_faults(reading_, machine_)}) {
      for (const auto& fault : all) {
        out += fault.file + ": " + fault.what + "\n";
      }
    }
    return out;
  }

  kernel::machine::Machine machine_;
  Reading reading_;
};

TEST_F(ValueFaults, WhatIsNotKnownOrWithinItsRangeIsNone) {
  EXPECT_EQ(faults(), "") << "nothing is known";
  show(Quantity::feed_panel_percent, 0.0);
  show(Quantity::spindle_effective_percent, 200.0);
  show_x(400.5);
  EXPECT_EQ(faults(), "");
}

TEST_F(ValueFaults, ANegativeScaleAndAWrongUnitAreNamed) {
  show(Quantity::feed_panel_percent, -100.0);
  show_x(250000.0);
  EXPECT_EQ(faults(),
            "map.toml: feed_panel_percent is -100 now; allowed: 0 … 200\n"
            "map.toml: command_mm of X is 250000 now, beyond its travel of -100 … 400\n");
}

TEST_F(ValueFaults, AGroupThatTheControlDoesNotTellIsNamed) {
  EXPECT_FALSE(motion_fault(reading_, machine_.opcua)) << "not mapped";
  for (const double number : {1.0, 10.0, 21.0}) {
    show(Quantity::motion_number, number);
    EXPECT_FALSE(motion_fault(reading_, machine_.opcua)) << number;
  }
  for (const double number : {0.0, 22.0, -1.0}) {
    show(Quantity::motion_number, number);
    const auto fault = motion_fault(reading_, machine_.opcua);
    ASSERT_TRUE(fault) << number;
    EXPECT_NE(fault->to_do.find("MD22510"), std::string::npos);
  }
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
