// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::motion::online {

/// Refusal of an estimator's Config: what was seen and what is allowed.
[[nodiscard]] inline kernel::outcome::Refusal refuse_config(std::string what) {
  return kernel::outcome::bad_input(std::move(what), "correct the settings of the estimator");
}

}  // namespace steadyrest::motion::online
