// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest doctor`: whether this machine file is fit for use, here and now.
void add_verb_doctor(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
