// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest motion estimate`: velocity and acceleration from a log of counts.
void add_verb_motion_estimate(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
