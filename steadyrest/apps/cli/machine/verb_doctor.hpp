// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest doctor`: is this machine file fit to be worked with, here and now?
void add_verb_doctor(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
