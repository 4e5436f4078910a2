// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/thermal/offline/log/log_inputs.hpp>

namespace steadyrest::thermal::offline {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;

kernel::outcome::Result<std::vector<const LogChannel*>> inputs_of(
    const kernel::machine::ThermalAxis& axis, const Log& log) {
  // By name and in the passport's order; a passport forecasts nothing from a log that lacks one
  // input.
  std::vector<const LogChannel*> out;
  out.reserve(axis.ambient.size());
  for (const auto& ambient : axis.ambient) {
    const auto found = std::ranges::find(log.temperature, ambient.sensor, &LogChannel::name);
    if (found == log.temperature.end()) {
      return std::unexpected(Refusal{
          Kind::bad_input, log.file, 0,
          fmt::format("the passport of {} needs the temperature {}, but the log does not have it",
                      axis.name, ambient.sensor),
          "log that sensor, or fit a passport without it: thermal fit --no-ambient"});
    }
    out.push_back(&*found);
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
