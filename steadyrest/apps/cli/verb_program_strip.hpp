// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/session.hpp>

namespace steadyrest::apps::cli {

void add_verb_program_strip(Session& session);

}  // namespace steadyrest::apps::cli
