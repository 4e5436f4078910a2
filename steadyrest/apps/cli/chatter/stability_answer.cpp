// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/apps/cli/chatter/stability_answer.hpp>

namespace steadyrest::apps::cli {

/// Over a long modulation period ρ is tiny or huge (2e-27 occurs), so its logarithm is in the
/// answer as well and is the number to compare.
void put_stability(Json& json, const chatter::offline::Stability& found) {
  json["spectral_radius"] = std::exp(found.log_radius);
  json["log_radius"] = found.log_radius;
  json["stable"] = found.stable;
  json["type"] = chatter::offline::name(found.type);
  json["frequency_hz"] = found.frequency_hz ? Json(*found.frequency_hz) : Json(nullptr);
}

}  // namespace steadyrest::apps::cli
