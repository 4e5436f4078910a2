// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/apps/cli/chatter/stability_answer.hpp>

namespace steadyrest::apps::cli {

void put_stability(Json& json, const chatter::offline::Stability& found) {
  json["spectral_radius"] = std::exp(found.log_radius);
  json["log_radius"] = found.log_radius;
  json["stable"] = found.stable;
  json["type"] = chatter::offline::name(found.type);
  json["frequency_hz"] = found.frequency_hz ? Json(*found.frequency_hz) : Json(nullptr);
}

}  // namespace steadyrest::apps::cli
