// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `steadyrest opcua trust`: shows the control's certificate, and trusts it once it is compared.
void add_verb_opcua_trust(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
