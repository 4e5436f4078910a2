// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/live_page/desk.hpp>

/// What the page asks of the rooms of the running layer.
namespace steadyrest::apps::live_page {

/// Sets the modulation at once: `modulation`, as it is in force.
[[nodiscard]] web::Response set_modulation(const Desk& desk, const Json& asked,
                                           const std::string& author);
/// A measured size: `verdict` with `taken`, `reason`, `sentence`.
[[nodiscard]] web::Response enter_measured(const Desk& desk, const Json& asked,
                                           const std::string& author);

}  // namespace steadyrest::apps::live_page
