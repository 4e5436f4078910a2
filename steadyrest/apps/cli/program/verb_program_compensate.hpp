// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program compensate`: writes a plan of corrections into an NC program, and proves it.
void add_verb_program_compensate(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
