// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest chatter fit`: modes from measured frequency responses.
void add_verb_chatter_fit(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
