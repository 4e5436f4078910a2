// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest record show`: what a record holds.
void add_verb_record_show(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
