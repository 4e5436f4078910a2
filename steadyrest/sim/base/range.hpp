// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::sim {

/// A number of the machine and its range, both ends allowed.
struct Range {
  const char* name;
  double value, low, high;
};

/// Refuses the first number outside its range (NaN always is).
[[nodiscard]] kernel::outcome::Result<void> in_range(std::string_view owner,
                                                     std::initializer_list<Range> ranges);

/// The refusal of something in the machine file.
[[nodiscard]] kernel::outcome::Refusal refusal(std::string what);

}  // namespace steadyrest::sim
