// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest record export`: a record as CSV.
void add_verb_record_export(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
