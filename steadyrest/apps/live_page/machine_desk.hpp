// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>

#include <steadyrest/apps/live_page/desk.hpp>

/// The machine file on the page: shown, checked with changes, and changed under the running layer.
namespace steadyrest::apps::live_page {

/// The file with its keys, their units, ranges and meanings, and what `doctor` finds in it.
[[nodiscard]] web::Response show_machine(const Desk& desk);
/// What changes would do: the difference, and why they would be refused.
[[nodiscard]] web::Response check_machine(const Desk& desk, const Json& asked);
/// Writes the file and has the loop take it over; puts the old one back where it does not.
[[nodiscard]] web::Response apply_machine(const Desk& desk, const Json& asked,
                                          const std::string& author, const std::stop_token& stop);

}  // namespace steadyrest::apps::live_page
