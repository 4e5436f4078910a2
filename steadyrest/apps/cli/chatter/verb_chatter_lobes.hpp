// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter lobes`: the stability map and its border.
void add_verb_chatter_lobes(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
