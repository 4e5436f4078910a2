// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest motion calibrate`: where the encoder's lines really are, from a log of edges.
void add_verb_motion_calibrate(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
