// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::record {

/// Runs the steps up to the first that is refused, and gives that refusal.
template <class... Steps>
[[nodiscard]] kernel::outcome::Result<void> in_turn(Steps&&... steps) {
  kernel::outcome::Result<void> done;
  static_cast<void>(((done = steps(), done.has_value()) && ...));
  return done;
}

}  // namespace steadyrest::record
