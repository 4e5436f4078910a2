// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest record list`: the records of a folder.
void add_verb_record_list(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
