// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <steadyrest/record/sample.hpp>

namespace steadyrest::record {

/// A column of a table that is worked out from a run's samples, given in their order.
struct Derived {
  std::string name;  ///< ends in its unit
  std::function<double(const Sample&)> value;
};

}  // namespace steadyrest::record
