// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/record/verb_record_list.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>

namespace steadyrest::apps::cli {
namespace record_list {
namespace {

using record::RecordReader;

/// A file that is no record does not hide the others: it is listed, refused, and the exit code
/// tells.
Outcome run(const std::string& folder) {
  const auto files = record::run_files(folder);
  if (!files) {
    return refused(files.error());
  }
  Answer answer;
  answer.json["records"] = Json::array();
  Table table({"file", "start (UTC)", "machine", "program", "seconds", "lost", "end"});
  for (const record::RunFile& file : *files) {
    const auto reader = RecordReader::open(file.file);
    if (!reader) {
      answer.refusals.push_back(reader.error());
      answer.exit_code = kRefused;
      continue;
    }
    const auto& run = reader->run();
    const auto& totals = reader->totals();
    const double seconds = static_cast<double>(totals.samples) * run.cycle_s;
    answer.json["records"].push_back({{"file", file.file},
                                      {"bytes", file.bytes},
                                      {"rotates", file.rotates},
                                      {"start_utc", run.start_utc},
                                      {"machine", run.machine},
                                      {"program", run.program},
                                      {"samples", totals.samples},
                                      {"seconds", seconds},
                                      {"dropped", totals.dropped},
                                      {"closed", totals.closed}});
    table.row({file.file, run.start_utc, run.machine, run.program, fmt::format("{:.1f}", seconds),
               fmt::format("{}", totals.dropped), totals.closed ? "in order" : "open"});
  }
  answer.text = answer.json["records"].empty() ? "no records\n" : table.text();
  return answer;
}

}  // namespace
}  // namespace record_list

void add_verb_record_list(Session& session, Verb& verb) {
  auto folder = std::make_shared<std::string>();
  verb.add_option("folder", *folder, "Folder with records (.sqlite)")
      ->required()
      ->option_text("FOLDER");
  session.on(verb, [folder](Progress& /*progress*/) { return record_list::run(*folder); });
}

}  // namespace steadyrest::apps::cli
