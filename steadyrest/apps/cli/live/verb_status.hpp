// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest status`: what a running layer sees and does.
void add_verb_status(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
