// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest motion encoder`: the encoder for a speed, and the speed for an encoder.
void add_verb_motion_encoder(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
