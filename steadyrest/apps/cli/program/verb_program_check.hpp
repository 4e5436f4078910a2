// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program check`: does an NC program contain anything that is not understood?
void add_verb_program_check(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
