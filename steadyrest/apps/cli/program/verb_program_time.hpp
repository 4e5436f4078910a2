// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program time`: how long a program takes on a machine, and where the time goes.
void add_verb_program_time(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
