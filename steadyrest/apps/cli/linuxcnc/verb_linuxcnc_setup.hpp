// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest linuxcnc setup`: the layer's HAL and INI lines into a configuration, or out of it.
void add_verb_linuxcnc_setup(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
