// SPDX-License-Identifier: Apache-2.0
// SINUMERIK 840D sl, "Job planning": R-parameters, DEF and the values of a call.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;
using read::ValueType;
using testing::ElementsAre;
using testing::Pair;

class SinumerikVariablesOf : public testing::Test {
 protected:
  [[nodiscard]] double named(const char* name) const {
    double value = -12345.0;
    EXPECT_EQ(variables_.name(name, value), Lookup::found) << name;
    return value;
  }
  [[nodiscard]] Lookup lookup(const char* name) const {
    double ignored = 0.0;
    return variables_.name(name, ignored);
  }
  [[nodiscard]] Lookup lookup(int index) const {
    double ignored = 0.0;
    return variables_.number(index, ignored);
  }
  SinumerikVariables variables_;
};

TEST_F(SinumerikVariablesOf, AreAThousandRParametersWithoutAValue) {
  for (const int index : {0, 1, 999}) {
    EXPECT_EQ(lookup(index), Lookup::no_such_name) << index;
    EXPECT_EQ(variables_.set_number(index, index), Lookup::found) << index;
  }
  EXPECT_EQ(lookup(999), Lookup::assigned_in_block);  // until the block has been read
  variables_.commit();
  EXPECT_EQ(lookup(999), Lookup::found);
  for (const int index : {-1, 1000}) {
    EXPECT_EQ(lookup(index), Lookup::no_such_number) << index;
    EXPECT_EQ(variables_.set_number(index, 1.0), Lookup::no_such_number) << index;
  }
  std::vector<std::pair<std::string, double>> list;
  variables_.list(list);
  EXPECT_THAT(list, ElementsAre(Pair("R0", 0.0), Pair("R1", 1.0), Pair("R999", 999.0)));
}

// Type conversion: INT rounds up from .5, BOOL is TRUE for everything but 0.
TEST_F(SinumerikVariablesOf, ConvertTheirValuesByTypeWheneverTheyAreSet) {
  EXPECT_TRUE(variables_.define("real", ValueType::real, 2.5));
  EXPECT_TRUE(variables_.define("int", ValueType::integer, 2.5));
  EXPECT_TRUE(variables_.define("bool", ValueType::boolean, -0.25));
  EXPECT_EQ(named("real"), 2.5);
  EXPECT_EQ(named("int"), 3.0);
  EXPECT_EQ(named("bool"), 1.0);
  for (const char* name : {"real", "int", "bool"}) {
    EXPECT_EQ(variables_.set_name(name, 0.4), Lookup::found);
    EXPECT_EQ(lookup(name), Lookup::assigned_in_block);
  }
  variables_.commit();
  EXPECT_EQ(named("real"), 0.4);
  EXPECT_EQ(named("int"), 0.0);
  EXPECT_EQ(named("bool"), 1.0);
  EXPECT_FALSE(variables_.define("int", ValueType::real, 1.0));
  EXPECT_EQ(variables_.set_name("other", 1.0), Lookup::no_such_name);
}

TEST_F(SinumerikVariablesOf, TakeTheValuesOfTheCallByPlace) {
  read::Flow call{};
  call.count = 4;
  call.given = 0b1101;
  call.values = {10.0, 0.0, 30.6, 40.0};
  variables_.enter(call);
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_TRUE(variables_.define_argument("a", ValueType::real, 0, -1.0));
    EXPECT_TRUE(variables_.define_argument("b", ValueType::real, 1, -2.0));
    EXPECT_TRUE(variables_.define_argument("c", ValueType::integer, 2, -3.0));
    EXPECT_FALSE(variables_.define_argument("a", ValueType::real, 2, 0.0));
    EXPECT_TRUE(variables_.values_left());  // PROC has three parameters, the call four values
    EXPECT_TRUE(variables_.define_argument("d", ValueType::real, 3, -4.0));
    EXPECT_FALSE(variables_.values_left());
    EXPECT_TRUE(variables_.define_argument("e", ValueType::real, 4, -5.0));
    EXPECT_EQ(named("a"), 10.0);
    EXPECT_EQ(named("b"), -2.0);  // left out
    EXPECT_EQ(named("c"), 31.0);
    EXPECT_EQ(named("e"), -5.0);  // beyond the last value
    variables_.restart();
    EXPECT_EQ(lookup("a"), Lookup::no_such_name);
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
