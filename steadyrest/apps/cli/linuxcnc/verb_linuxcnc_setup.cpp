// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/setup.hpp>
#include <steadyrest/apps/cli/linuxcnc/verb_linuxcnc_setup.hpp>
#include <steadyrest/kernel/file/unified_diff.hpp>

// Everything is planned before anything is written; the difference shown is the one that is made.
namespace steadyrest::apps::cli {
namespace linuxcnc_setup {
namespace {

namespace config = adapters::linuxcnc::config;

struct Options {
  std::string ini;
  bool undo = false;
  bool dry_run = false;
  config::SetupOptions setup;
};

const char* change_of(const config::FileChange& change) {
  return !change.before ? "created" : !change.after ? "removed" : "changed";
}

Answer answer_of(const config::SetupPlan& plan, const Options& options) {
  Answer answer;
  answer.json["ini"] = options.ini;
  answer.json["undo"] = options.undo;
  answer.json["dry_run"] = options.dry_run;
  answer.json["files"] = Json::array();
  answer.json["notes"] = Json::array();
  std::string files;
  for (const config::FileChange& change : plan.files) {
    const std::string diff = kernel::file::unified_diff(change.file, change.before, change.after);
    answer.json["files"].push_back(
        {{"file", change.file}, {"change", change_of(change)}, {"diff", diff}});
    answer.text += diff;
    files += fmt::format("{}{} {}\n", options.dry_run ? "would be " : "", change_of(change),
                         change.file);
  }
  // After the diff, which `patch` reads; it skips text like this.
  answer.text += "\n" + files;
  for (const config::Note& note : plan.notes) {
    answer.json["notes"].push_back(
        {{"file", note.file}, {"line", note.line}, {"what", note.what}, {"to_do", note.to_do}});
    answer.text += "note: ";
    if (!note.file.empty()) {
      answer.text +=
          note.line == 0 ? note.file + ": " : fmt::format("{}:{}: ", note.file, note.line);
    }
    answer.text += note.what;
    answer.text += note.to_do == "nothing" ? "\n" : "; " + note.to_do + "\n";
  }
  if (!options.dry_run) {
    answer.text += "restart LinuxCNC for it to take effect\n";
  }
  return answer;
}

Outcome run(const Options& options) {
  const auto plan = options.undo ? config::plan_undo(options.ini)
                                 : config::plan_setup(options.ini, options.setup);
  if (!plan) {
    return refused(plan.error());
  }
  if (!options.dry_run) {
    if (const auto done = config::carry_out(*plan); !done) {
      return refused(done.error());
    }
  }
  return answer_of(*plan, options);
}

}  // namespace
}  // namespace linuxcnc_setup

void add_verb_linuxcnc_setup(Session& session, Verb& verb) {
  auto options = std::make_shared<linuxcnc_setup::Options>();
  verb.reads("INI", options->ini, "INI file that LinuxCNC is started with")->required();
  CLI::Option* const undo =
      verb.add_flag("--undo", options->undo, "Take everything out again, byte for byte");
  verb.add_flag("--dry-run", options->dry_run, "Show the difference, write nothing");
  CLI::Option* const offsets =
      verb.add_flag("--offsets", options->setup.offsets, "Connect the axis offsets, too")
          ->excludes(undo);
  verb.add_option("--offset-share", options->setup.offset_share,
                  "OFFSET_AV_RATIO: share of an axis's speed and acceleration that is kept for "
                  "offsets, 0.01 to 0.9")
      ->check(CLI::Range(0.01, 0.9))
      ->needs(offsets)
      ->excludes(undo);
  session.on(verb, [options](Progress& /*progress*/) { return linuxcnc_setup::run(*options); });
}

}  // namespace steadyrest::apps::cli
