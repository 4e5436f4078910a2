// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program moves`: the moves of an NC program as CSV.
void add_verb_program_moves(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
