// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `thermal plan`: the system R of corrections.
void add_verb_thermal_plan(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
