// SPDX-License-Identifier: Apache-2.0
// What comes from the control's past, what a call gives back, and what a probing move leaves.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/parameters/parameters.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;
using testing::ElementsAre;
using testing::Pair;

class KeptParameters : public testing::Test {
 protected:
  KeptParameters() { parameters_.bind(state_, config_); }
  [[nodiscard]] double number(int index) const {
    double value = -12345.0;
    EXPECT_EQ(parameters_.number(index, value), Lookup::found) << index;
    return value;
  }
  [[nodiscard]] double named(const std::string& name) const {
    double value = -12345.0;
    EXPECT_EQ(parameters_.name(name, value), Lookup::found) << name;
    return value;
  }
  /// What the control was asked for since the last time.
  std::string asked() {
    const std::string value = parameters_.asked().value;
    parameters_.asked().clear();
    return value;
  }
  State state_;
  Config config_;
  Parameters parameters_;
};

TEST_F(KeptParameters, ANumberThatWasNeverSetIsZeroAndAsksTheControl) {
  EXPECT_EQ(number(31), 0.0);
  EXPECT_EQ(asked(), "#31");
  parameters_.set_number(31, 4.0);
  parameters_.commit();
  EXPECT_EQ(number(31), 4.0);
  EXPECT_EQ(asked(), "");
  parameters_.keep(std::vector<std::pair<int, double>>{{100, 3.0}, {5063, 9.0}, {0, 1.0}});
  EXPECT_EQ(number(100), 3.0);
  EXPECT_EQ(asked(), "");
  EXPECT_EQ(number(5063), 0.0);  // probe results are not kept
  EXPECT_EQ(asked(), "#5063");
}

// Its memory may hold anything from before: by hand, or from another program.
TEST_F(KeptParameters, OnTheControlWhatWasNotSetIsNotTakenAsZero) {
  config_.on_control = true;
  double value = 0.0;
  EXPECT_EQ(parameters_.number(31, value), Lookup::kept_by_control);
  EXPECT_EQ(parameters_.number(5061, value), Lookup::kept_by_control);
  EXPECT_EQ(parameters_.name("_width", value), Lookup::kept_by_control);
  EXPECT_EQ(parameters_.name("width", value), Lookup::no_such_name);  // local: gone with its call
  parameters_.keep(std::vector<std::pair<int, double>>{{31, 4.0}});
  EXPECT_EQ(number(31), 4.0);
  parameters_.set_name("_width", 5.0);
  parameters_.commit();
  EXPECT_EQ(named("_width"), 5.0);
  // The interpreter of the running control says so of itself; rs274 alone does not.
  EXPECT_EQ(named("_task"), 1.0);
  config_.on_control = false;
  EXPECT_EQ(named("_task"), 0.0);
}

TEST_F(KeptParameters, AreListedWhereTheyAreSet) {
  parameters_.set_number(100, 3.0);
  parameters_.set_number(7, 2.0);
  parameters_.set_name("_width", 5.0);
  parameters_.set_name("_depth", 6.0);
  parameters_.set_name("local", 1.0);
  parameters_.commit();
  std::vector<std::pair<std::string, double>> list;
  parameters_.list(list);
  EXPECT_THAT(list, ElementsAre(Pair("#7", 2.0), Pair("#100", 3.0), Pair("#5599", 1.0),
                                Pair("#<_depth>", 6.0), Pair("#<_width>", 5.0)));
}

TEST_F(KeptParameters, ACallByNumberSharesThemWithItsCaller) {
  parameters_.set_number(1, 3.0);
  parameters_.set_name("local", 4.0);
  parameters_.commit();
  parameters_.enter_shared();
  EXPECT_EQ(number(1), 3.0);
  EXPECT_EQ(named("local"), 4.0);
  parameters_.set_number(1, 5.0);
  parameters_.commit();
  parameters_.leave(nullptr);
  EXPECT_EQ(number(1), 5.0);
}

// Its end is in the program's units, angles in degrees; where the probe touches is not known.
TEST_F(KeptParameters, AProbingMoveLeavesItsEndAndMakesItUncertain) {
  state_.unit_mm = 25.4;
  parameters_.record_probe({25.4, -50.8, 2.54, 30.0, 0.0, 0.0, 0.0, 0.0, 12.7});
  EXPECT_DOUBLE_EQ(number(5061), 1.0);
  EXPECT_EQ(asked(), "#5061");
  EXPECT_DOUBLE_EQ(number(5062), -2.0);
  EXPECT_DOUBLE_EQ(number(5063), 0.1);
  EXPECT_DOUBLE_EQ(number(5064), 30.0);
  EXPECT_DOUBLE_EQ(number(5069), 0.5);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
