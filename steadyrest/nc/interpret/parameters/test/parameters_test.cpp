// SPDX-License-Identifier: Apache-2.0
// LinuxCNC 2.9, "Parameters": which numbers exist, which are read only, what belongs to a call.
#include <array>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/interpret/parameters/parameters.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;

/// Parameters of a machine in its state at the start.
struct BoundParameters {
  BoundParameters() { parameters.bind(state, config); }
  [[nodiscard]] double operator[](int index) const {
    double value = -12345.0;
    EXPECT_EQ(parameters.number(index, value), Lookup::found) << index;
    return value;
  }
  void set(int index, double value) {
    EXPECT_EQ(parameters.set_number(index, value), Lookup::found) << index;
    parameters.commit();
  }
  State state;
  Config config;
  Parameters parameters;
};

TEST(Parameters, AreNumberedUpTo5601AndSomeAreReadOnly) {
  BoundParameters bound;
  double value = 0.0;
  for (const int index : {-1, 0, 5602, 100000}) {
    EXPECT_EQ(bound.parameters.number(index, value), Lookup::no_such_number) << index;
    EXPECT_EQ(bound.parameters.set_number(index, 1.0), Lookup::no_such_number) << index;
  }
  for (int index = 1; index <= 5601; ++index) {
    const bool tool = index >= 5400 && index <= 5413;
    const bool position = index >= 5420 && index <= 5428;
    const bool in_force = index == 5210 || index == 5220;
    EXPECT_EQ(bound.parameters.set_number(index, 1.0),
              tool || position || in_force ? Lookup::read_only : Lookup::found)
        << index;
  }
}

// A line's assignments act together at its end: `#1=2 G0 X#1` moves to the old #1.
TEST(Parameters, AreSetAtTheEndOfTheirLine) {
  BoundParameters bound;
  bound.set(1, 7.0);
  bound.parameters.set_number(1, 8.0);
  bound.parameters.set_name("depth", 9.0);
  double value = 0.0;
  EXPECT_EQ(bound[1], 7.0);
  EXPECT_EQ(bound.parameters.name("depth", value), Lookup::no_such_name);
  bound.parameters.drop();
  bound.parameters.commit();
  EXPECT_EQ(bound[1], 7.0);
  EXPECT_EQ(bound.parameters.name("depth", value), Lookup::no_such_name);
}

// Against a stack of maps: #1 … #30 are a call's own, and the caller's again after it.
TEST(Parameters, OfACallAreItsOwnUpToThirty) {
  EXPECT_TRUE(rc::check([] {
    BoundParameters bound;
    std::vector<std::map<int, double>> calls(1);
    std::map<int, double> common;
    for (int i = 0; i < 60; ++i) {
      const int index = *rc::gen::inRange(1, 61);
      const int action = *rc::gen::inRange(0, 6);
      if (action == 0 && calls.size() < 10) {
        const std::array<double, 2> arguments = {10.0 + i, 20.0 + i};
        bound.parameters.enter(arguments);
        calls.push_back({{1, arguments[0]}, {2, arguments[1]}});
      } else if (action == 1 && calls.size() > 1) {
        bound.parameters.leave(nullptr);
        calls.pop_back();
      } else {
        bound.set(index, i);
        (index <= 30 ? calls.back() : common)[index] = i;
      }
      RC_ASSERT(bound[index] == (index <= 30 ? calls.back() : common)[index]);
      RC_ASSERT(bound.parameters.calls() == calls.size() - 1);
    }
  }));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
