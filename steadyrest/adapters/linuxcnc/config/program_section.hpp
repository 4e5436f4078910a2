// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_text.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// What the INI file tells the interpreter: [program] of the machine file, and the rest by name.
struct ProgramSection {
  std::string text;
  std::vector<FoundValue> values;
  std::vector<std::string> not_carried;
};

/// `hal_unread`: why the HAL files are not read; empty where they are.
[[nodiscard]] ProgramSection program_section(const IniFile& ini, const Configuration& machine,
                                             const std::string& hal_unread);

/// The laws of LinuxCNC's planner that no machine changes, and that of 2.10 with limited jerk where
/// the INI file asks for it by PLANNER_TYPE and MAX_LINEAR_JERK (below 1 it is the one of 2.9):
/// keys of [control]. Refused: what figure() refuses.
[[nodiscard]] kernel::outcome::Result<ProgramSection> planner_laws(const IniFile& ini,
                                                                   double mm_per_unit);

/// Text for a comment of a TOML file; anything but printable ASCII would need TOML's rules there.
[[nodiscard]] std::string comment_of(std::string_view text);

/// A TOML string of `text`, at most `most` characters; bytes that are not text become `?`.
[[nodiscard]] std::string toml_string(std::string_view text, std::size_t most);

}  // namespace steadyrest::adapters::linuxcnc::config
