// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <expected>
#include <filesystem>
#include <fstream>
#include <iterator>
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
constexpr const char* kPlcBlock = "STEADYREST.SCL";

struct Options {
  std::string machine;
  std::string folder;
};

/// Empty: there is none, or it cannot be read.
std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_there(const std::string& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// A machine has its own PROG_EVENT.SPF, a copy of which may be in that folder; and a text of
/// another mapping must not be loaded beside these.
std::expected<void, Refusals> check_folder(const std::string& folder,
                                           const std::vector<kernel::file::FileText>& files) {
  Refusals out;
  for (const auto& [file, text] : files) {
    if (is_there(file) && text_of(file).find(kMark) == std::string::npos) {
      out.push_back(bad_input(file, "is there already, and is not of this program",
                              "name another folder, or move it away"));
    }
  }
  const std::string block = folder + "/" + kPlcBlock;
  if (is_there(block) &&
      std::ranges::find(files, block, &kernel::file::FileText::file) == files.end()) {
    out.push_back(bad_input(block,
                            "is of another mapping: it must not be loaded beside STEADYREST.SPF",
                            "remove it, or name another folder"));
  }
  if (out.empty()) {
    return {};
  }
  return std::unexpected(std::move(out));
}

/// What was there and is another text stays beside, with `.old` behind its name: somebody may have
/// changed it.
void keep_old(std::vector<kernel::file::FileText>& files, Answer& answer) {
  const std::size_t count = files.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (std::string before = text_of(files[i].file); !before.empty() && before != files[i].text) {
      answer.text += fmt::format("the former {} is {}.old now\n", files[i].file, files[i].file);
      files.push_back({.file = files[i].file + ".old", .text = std::move(before)});
    }
  }
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
  if (auto free = check_folder(options.folder, files); !free) {
    return std::unexpected(std::move(free.error()));
  }
  keep_old(files, answer);
  if (const auto written = kernel::file::write_files(files); !written) {
    return refused(written.error());
  }
  const double slowest_s = adapters::opcua::longest_hand_back_s(*machine);
  answer.json["neutral_after_s"] = slowest_s;
  answer.text += adapters::opcua::has_offsets(*machine)
                     ? fmt::format(
                           "With axis offsets of up to {:g} µm; max_offset_um = 0 leaves "
                           "them out.\n",
                           1e3 * machine->envelope.max_offset_mm)
                     : "Without axis offsets.\n";
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
