// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest mode`: observe, advise or act from now on.
void add_verb_mode(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
