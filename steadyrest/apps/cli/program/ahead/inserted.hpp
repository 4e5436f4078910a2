// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>

namespace steadyrest::apps::cli {

/// The keys `insertions[]`, `inserted_lines`, `seconds` and `proved_moves`, and a table for people:
/// a row for each place where corrections were inserted.
[[nodiscard]] std::string put_insertions(Answer& answer, const nc::rewrite::Compensated& done);

}  // namespace steadyrest::apps::cli
