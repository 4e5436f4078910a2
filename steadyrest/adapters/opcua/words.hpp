// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/links/opcua.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// What the bridge's word for a fault means, and what to do.
[[nodiscard]] kernel::outcome::Refusal refusal_of(std::string_view why, const std::string& detail,
                                                  const kernel::machine::OpcUa& config);

}  // namespace steadyrest::adapters::opcua
