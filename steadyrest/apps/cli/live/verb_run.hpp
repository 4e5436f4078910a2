// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest run`: the layer, live, on the port of the machine file.
void add_verb_run(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
