// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest program speeds`: spindle speeds that keep the cuts stable, written as S words.
void add_verb_program_speeds(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
