// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::apps::cli {

void add_machine_option(Verb& verb, std::string& path) {
  verb.reads("--machine", path, "Machine file (TOML); its keys are in docs/machine-file.md")
      ->required()
      ->option_text("FILE");
}

std::expected<kernel::machine::Machine, Refusals> read_machine(const std::string& path) {
  return passport::read_all_faults(path);
}

}  // namespace steadyrest::apps::cli
