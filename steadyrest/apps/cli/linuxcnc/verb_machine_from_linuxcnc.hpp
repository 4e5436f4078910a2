// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest machine from-linuxcnc`: the machine file of a LinuxCNC configuration.
void add_verb_machine_from_linuxcnc(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
