// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter plan`: the override step or the speed law that keeps a cut stable.
void add_verb_chatter_plan(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
