// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/heat_history.hpp>

/// What the page asks of the rooms of the running layer.
namespace steadyrest::apps::live_page {

/// Sets the modulation at once: `modulation`, as it is in force.
[[nodiscard]] web::Response set_modulation(const Desk& desk, const Json& asked,
                                           const std::string& author);
/// A measured size: `verdict` with `taken`, `reason`, `sentence`. The history keeps it.
[[nodiscard]] web::Response enter_measured(const Desk& desk, HeatHistory& heat, const Json& asked,
                                           const std::string& author);

}  // namespace steadyrest::apps::live_page
