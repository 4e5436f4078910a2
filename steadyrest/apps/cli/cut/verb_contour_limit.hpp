// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest contour limit`: contour error of an arc and the feed that keeps it, in closed form.
void add_verb_contour_limit(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
