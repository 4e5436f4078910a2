// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::online {

/// Refusal of a Config of the detector or its parts.
[[nodiscard]] inline std::unexpected<kernel::outcome::Refusal> refuse_detector(std::string what) {
  return kernel::outcome::refuse(std::move(what), "correct the detector's setup");
}

}  // namespace steadyrest::chatter::online
