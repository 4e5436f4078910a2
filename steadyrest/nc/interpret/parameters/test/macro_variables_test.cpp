// SPDX-License-Identifier: Apache-2.0
// FANUC Series 30i operator's manual, "Custom macro": variables and system variables.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/parameters/test/macro_variables_of.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;
using test::MacroVariablesOf;
using testing::ElementsAre;
using testing::Pair;

// #0 is always vacant; #1–#33 are local, #100–#199 and #500–#999 common.
TEST_F(MacroVariablesOf, ThreeRangesCanBeSetAndAreNotKnownAtTheStart) {
  double value = 0.0;
  for (int index = 0; index < 1000; ++index) {
    const bool exists =
        (index >= 1 && index <= 33) || (index >= 100 && index <= 199) || index >= 500;
    EXPECT_EQ(variables_.number(index, value), exists       ? Lookup::no_such_name
                                               : index == 0 ? Lookup::vacant
                                                            : Lookup::no_such_number)
        << index;
    EXPECT_EQ(variables_.set_number(index, 1.0), exists       ? Lookup::found
                                                 : index == 0 ? Lookup::read_only
                                                              : Lookup::no_such_number)
        << index;
  }
  EXPECT_EQ(variables_.set_number(5001, 1.0), Lookup::read_only);
}

TEST_F(MacroVariablesOf, AnAssignmentWaitsForTheEndOfItsBlock) {
  variables_.set_number(500, 2.5);
  EXPECT_THAT(value_of(500), ElementsAre());
  variables_.commit();
  EXPECT_THAT(value_of(500), ElementsAre(2.5));
  variables_.set_number(500, 9.0);
  variables_.set_number(1, 9.0);
  variables_.drop();
  variables_.commit();
  std::vector<std::pair<std::string, double>> list;
  variables_.list(list);
  EXPECT_THAT(list, ElementsAre(Pair("#500", 2.5)));
}

// Increment system IS-B.
TEST_F(MacroVariablesOf, AddressesHaveTheirLeastIncrement) {
  EXPECT_EQ(variables_.increment('X'), 0.001);
  EXPECT_EQ(variables_.increment('B'), 0.001);
  EXPECT_EQ(variables_.increment('F'), 0.0);
  state_.unit_mm = 25.4;
  EXPECT_EQ(variables_.increment('R'), 0.0001);
  EXPECT_EQ(variables_.increment('C'), 0.001);
  EXPECT_EQ(variables_.increment('S'), 0.0);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
