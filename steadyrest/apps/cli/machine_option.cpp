// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/machine_option.hpp>
#include <steadyrest/kernel/machine/machine_file.hpp>

namespace steadyrest::apps::cli {

void add_machine_option(Verb& verb, std::string& path) {
  verb.reads("--machine", path, "Machine file (TOML); docs/machine-file.md has its keys")
      ->required()
      ->option_text("FILE");
}

std::expected<kernel::machine::Machine, Refusals> read_machine(const std::string& path) {
  return kernel::machine::read_all_faults(path);
}

}  // namespace steadyrest::apps::cli
