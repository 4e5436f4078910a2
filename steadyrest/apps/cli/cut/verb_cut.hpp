// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `cut PROGRAM --machine M [--report DIR]`: the main job. The part is cut twice on the simulated
/// machine, without and with the layer, and the two are compared.
void add_verb_cut(Session& session, Verb& verb);

}  // namespace steadyrest::apps::cli
