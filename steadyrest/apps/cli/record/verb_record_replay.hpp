// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest record replay`: a recorded run, decided again.
void add_verb_record_replay(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
