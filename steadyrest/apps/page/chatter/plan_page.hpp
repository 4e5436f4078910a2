// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::page {

/// The page of `chatter plan`: the lobes at constant speed over the override steps, with the
/// alternatives in them and, if a law was chosen, its border.
[[nodiscard]] kernel::outcome::Result<Json> plan_page(const Json& answer,
                                                      const chatter::offline::Process& process,
                                                      const kernel::machine::Machine& machine,
                                                      double programmed_rev_s,
                                                      const chatter::offline::Plan& plan);

}  // namespace steadyrest::apps::page
