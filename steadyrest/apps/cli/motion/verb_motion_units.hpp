// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest motion units`: feed and overload in counts and ticks, and back.
void add_verb_motion_units(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
