// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `thermal adapt`: measured parts change the level k and the gains of the model.
void add_verb_thermal_adapt(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
