// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter radius`: whether a cut is stable at one speed and depth.
void add_verb_chatter_radius(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
