// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `thermal forecast`: the displacement with its uncertainty.
void add_verb_thermal_forecast(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
