// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/sim/base/range.hpp>

namespace steadyrest::sim {

kernel::outcome::Refusal refusal(std::string what) {
  return kernel::outcome::bad_input(std::move(what), "correct the machine file");
}

// Written as not (low ≤ value ≤ high): a NaN fails it.
kernel::outcome::Result<void> in_range(std::string_view owner,
                                       std::initializer_list<Range> ranges) {
  for (const Range& r : ranges) {
    if (!(r.value >= r.low && r.value <= r.high)) {
      return std::unexpected(refusal(
          fmt::format("{}: {} is {}; allowed: {} to {}", owner, r.name, r.value, r.low, r.high)));
    }
  }
  return {};
}

}  // namespace steadyrest::sim
