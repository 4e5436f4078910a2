// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::offline {

/// The log's temperatures for the passport's ambient inputs, in their order. Refused: a log that
/// lacks one of them.
[[nodiscard]] kernel::outcome::Result<std::vector<const LogChannel*>> inputs_of(
    const kernel::machine::ThermalAxis& axis, const Log& log);

/// The passport's model, and its ambient inputs in the log.
struct ModelOnLog {
  online::ThermalModel model;
  std::vector<const LogChannel*> sensor;
};
[[nodiscard]] kernel::outcome::Result<ModelOnLog> model_on(const kernel::machine::ThermalAxis& axis,
                                                           const Log& log);

/// The inputs of a row.
[[nodiscard]] online::Drive drive_at(const Log& log, const std::vector<const LogChannel*>& sensor,
                                     std::size_t row);

}  // namespace steadyrest::thermal::offline
