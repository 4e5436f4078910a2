// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `thermal fit`: the thermal passport of a machine from the log of a test.
void add_verb_thermal_fit(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
