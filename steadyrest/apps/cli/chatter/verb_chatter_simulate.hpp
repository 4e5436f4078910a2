// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter simulate`: a cut over time, with the tool leaving the material.
void add_verb_chatter_simulate(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
