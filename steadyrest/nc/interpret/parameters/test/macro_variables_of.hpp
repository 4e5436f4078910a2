// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/parameters/macro_variables.hpp>

namespace steadyrest::nc::interpret::test {

/// The macro variables of a control in its state at the start.
class MacroVariablesOf : public testing::Test {
 protected:
  /// A system variable's value; none where only the control knows it.
  [[nodiscard]] std::vector<double> value_of(int index) const {
    double value = 0.0;
    return variables_.number(index, value) == read::Lookup::found ? std::vector{value}
                                                                  : std::vector<double>{};
  }
  State state_;
  MacroVariables variables_{state_};
};

}  // namespace steadyrest::nc::interpret::test
