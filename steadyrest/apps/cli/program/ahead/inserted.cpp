// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/inserted.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>

namespace steadyrest::apps::cli {

std::string put_insertions(Answer& answer, const nc::rewrite::Compensated& done) {
  Table table({"line", "axis", "time s", "planned s", "shift um", "total um", "place"});
  answer.json["insertions"] = Json::array();
  for (const auto& one : done.insertions) {
    answer.json["insertions"].push_back({{"line", one.line},
                                         {"original_line", one.original_line},
                                         {"axis", std::string(1, one.axis)},
                                         {"time_s", one.time_s},
                                         {"planned_s", one.planned_s},
                                         {"delta_um", one.delta_um},
                                         {"total_um", one.total_um},
                                         {"place", nc::rewrite::name(one.site)}});
    table.row({fmt::format("{}", one.line), std::string(1, one.axis),
               fmt::format("{:.1f}", one.time_s), fmt::format("{:.1f}", one.planned_s),
               fmt::format("{:.2f}", one.delta_um), fmt::format("{:.2f}", one.total_um),
               std::string(nc::rewrite::name(one.site))});
  }
  answer.json["inserted_lines"] = done.inserted_lines;
  answer.json["seconds"] = done.program_s;
  answer.json["proved_moves"] = done.proof.moves;
  return done.insertions.empty() ? "the plan corrects nothing\n" : table.text();
}

}  // namespace steadyrest::apps::cli
