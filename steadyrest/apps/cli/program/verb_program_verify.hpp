// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program verify`: proves that a changed program differs from its original only by a
/// plan's corrections, by blocks replaced within a tube, or by both.
void add_verb_program_verify(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
