// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program check`: whether an NC program contains anything that is not understood.
void add_verb_program_check(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
