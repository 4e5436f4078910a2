// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program strip`: removes the corrections from an NC program, byte for byte.
void add_verb_program_strip(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
