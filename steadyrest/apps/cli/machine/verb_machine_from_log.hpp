// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest machine from-log`: servo gains and feed-forward of a machine file, from a record.
void add_verb_machine_from_log(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
