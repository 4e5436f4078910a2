// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program feeds`: the fastest feeds that keep a contour error, written as F words.
void add_verb_program_feeds(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
