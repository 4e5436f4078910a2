// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/control_text.hpp>
#include <steadyrest/apps/cli/opcua/verb_opcua_texts.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/kernel/file/output_file.hpp>

namespace steadyrest::apps::cli {
namespace opcua_texts {
namespace {

struct Options {
  std::string machine;
  std::string folder;
};

Outcome run(const Options& options) {
  auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  auto texts = adapters::opcua::control_texts(*machine);
  if (!texts) {
    return refused(texts.error());
  }
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) {
    return refused(bad_input(options.folder, "cannot be made: " + error.message(),
                             "name a folder that you may write"));
  }
  std::vector<kernel::file::FileText> files;
  Answer answer;
  answer.json["files"] = Json::array();
  for (auto& text : *texts) {
    files.push_back({.file = options.folder + "/" + text.name, .text = std::move(text.text)});
    answer.json["files"].push_back(files.back().file);
    answer.text += files.back().file + "\n";
  }
  if (const auto written = kernel::file::write_files(files); !written) {
    return refused(written.error());
  }
  const double slowest_s =
      adapters::opcua::neutral_after_s(*machine, machine->envelope.min_feed_ratio);
  answer.json["neutral_after_s"] = slowest_s;
  answer.text += fmt::format(
      "Without orders the control is neutral after {:.2f} s at most. How to load the files: "
      "docs/opcua.md\n",
      slowest_s);
  return answer;
}

}  // namespace
}  // namespace opcua_texts

void add_verb_opcua_texts(Session& session, Verb& verb) {
  auto options = std::make_shared<opcua_texts::Options>();
  add_machine_option(verb, options->machine);
  verb.add_option("-o,--output", options->folder, "Folder for the files")
      ->type_name("FOLDER")
      ->required();
  session.on(verb, [options](Progress& /*progress*/) { return opcua_texts::run(*options); });
}

}  // namespace steadyrest::apps::cli
