// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest opcua texts`: the files that the machine builder loads into the control.
void add_verb_opcua_texts(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
