// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>

namespace steadyrest::apps::cli {

/// spectral_radius, log_radius, stable, type, frequency_hz.
void put_stability(Json& json, const chatter::offline::Stability& found);

}  // namespace steadyrest::apps::cli
