// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/offline/log/log_inputs.hpp>

namespace steadyrest::thermal::offline {

using kernel::outcome::refuse;

kernel::outcome::Result<std::vector<const LogChannel*>> inputs_of(
    const kernel::machine::ThermalAxis& axis, const Log& log) {
  // By name and in the passport's order; a passport forecasts nothing from a log that lacks an
  // input.
  std::vector<const LogChannel*> out;
  out.reserve(axis.ambient.size());
  for (const auto& ambient : axis.ambient) {
    const auto found = std::ranges::find(log.temperature, ambient.sensor, &LogChannel::name);
    if (found == log.temperature.end()) {
      return refuse(
          log.file,
          fmt::format("the passport of {} needs the temperature {}, but the log does not have it",
                      axis.name, ambient.sensor),
          "log that sensor, or fit a passport without it: thermal fit --no-ambient");
    }
    out.push_back(&*found);
  }
  return out;
}

kernel::outcome::Result<ModelOnLog> model_on(const kernel::machine::ThermalAxis& axis,
                                             const Log& log) {
  auto model = online::ThermalModel::make(axis);
  if (!model) {
    return std::unexpected(model.error());
  }
  auto sensor = inputs_of(axis, log);
  if (!sensor) {
    return std::unexpected(sensor.error());
  }
  return ModelOnLog{std::move(*model), std::move(*sensor)};
}

online::Drive drive_at(const Log& log, const std::vector<const LogChannel*>& sensor,
                       std::size_t row) {
  online::Drive drive;
  drive.speed_rev_s = log.speed_rev_s[row];
  drive.ambient_c.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t j = 0; j < sensor.size(); ++j) {
    drive.ambient_c[j] = sensor[j]->value[row];
  }
  return drive;
}

}  // namespace steadyrest::thermal::offline
