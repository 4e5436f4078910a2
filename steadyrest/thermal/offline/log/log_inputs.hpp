// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// The log's temperatures that the passport's ambient inputs are, in their order. Refused: a log
/// that has not all of them.
[[nodiscard]] kernel::outcome::Result<std::vector<const LogChannel*>> inputs_of(
    const kernel::machine::ThermalAxis& axis, const Log& log);

}  // namespace steadyrest::thermal::offline
