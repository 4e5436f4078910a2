// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest lines test`: the override lines' wiring, before a layer uses it.
void add_verb_lines_test(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
