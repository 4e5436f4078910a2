// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter detect`: where a recorded vibration chatters, at which frequency, and which
/// override step would be better.
void add_verb_chatter_detect(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
