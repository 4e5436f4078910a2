// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// program predistort: the contour error cancelled by the program's text.
void add_verb_program_predistort(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
