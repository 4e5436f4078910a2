// SPDX-License-Identifier: Apache-2.0
#include <expected>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
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

constexpr std::string_view kMark = "Written by: steadyrest opcua texts";
constexpr std::size_t kHead = 1000;  ///< bytes in which the mark is

struct Options {
  std::string machine;
  std::string folder;
};

/// A machine has its own PROG_EVENT.SPF; a copy of it may be in that folder.
std::expected<void, Refusals> check_ours(const std::vector<kernel::file::FileText>& files) {
  Refusals out;
  for (const auto& file : files) {
    std::error_code error;
    if (!std::filesystem::exists(file.file, error)) {
      continue;
    }
    std::ifstream in(file.file, std::ios::binary);
    std::string head(kHead, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    if (head.find(kMark) == std::string::npos) {
      out.push_back(bad_input(file.file, "is there already, and is not of this program",
                              "name another folder, or move it away"));
    }
  }
  if (out.empty()) {
    return {};
  }
  return std::unexpected(std::move(out));
}

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
  if (auto ours = check_ours(files); !ours) {
    return std::unexpected(std::move(ours.error()));
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
