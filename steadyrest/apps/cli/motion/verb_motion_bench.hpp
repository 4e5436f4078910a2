// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest motion bench`: all estimators on all scenes, with known truth.
void add_verb_motion_bench(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
