// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program correct`: speeds, path, feeds and a plan's corrections written into one
/// program.
void add_verb_program_correct(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
