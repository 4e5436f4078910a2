// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/live_page/desk.hpp>

/// Past runs on the page. A record is named by its file's name alone: no path leads out of the
/// folder.
namespace steadyrest::apps::live_page {

/// Those whose name, machine or program has the words of `search`.
[[nodiscard]] web::Response list_records(const Desk& desk, const web::Request& request);
/// `/api/v1/records/NAME`, and what comes behind it: `data`, `export`.
[[nodiscard]] web::Response show_record(const Desk& desk, const web::Request& request,
                                        const std::string& rest);
/// Decides a recorded run again: `cycles`, `first_difference` (the cycle; null: none), its
/// `fields`.
[[nodiscard]] web::Response replay_record(const Desk& desk, const std::string& name);

}  // namespace steadyrest::apps::live_page
