// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

void add_verb_page_add_user(Session& session, Verb& verb);
void add_verb_page_add_token(Session& session, Verb& verb);
void add_verb_page_remove(Session& session, Verb& verb);
void add_verb_page_list(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
