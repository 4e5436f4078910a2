// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stop_token>
#include <string>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/past_runs/overview.hpp>

/// Past runs on the page. A record is named by its file's name alone: no path leads out of the
/// folder. These answers take long and are made in threads of their own.
namespace steadyrest::apps::live_page {

using Query = std::map<std::string, std::string>;

struct RecordAsked {
  const Query& query;
  const std::string& rest;  ///< after `/api/v1/records/`: NAME, perhaps with `/data` or `/export`
  const std::stop_token& stop;
};

/// Those whose name, machine or program contains `search`, the newest first. One that cannot be
/// read has `name`, `bytes` and why, `damaged`. Refuses a folder that cannot be read.
[[nodiscard]] web::Response list_records(const Desk& desk, const Query& query,
                                         const std::stop_token& stop);
[[nodiscard]] web::Response show_record(const Desk& desk, past_runs::Overviews& overviews,
                                        const RecordAsked& asked);
/// Decides a recorded run again: `cycles`, `first_difference` (the cycle; null: none), its
/// `fields`.
[[nodiscard]] web::Response replay_record(const Desk& desk, const std::string& name,
                                          const std::stop_token& stop);

}  // namespace steadyrest::apps::live_page
