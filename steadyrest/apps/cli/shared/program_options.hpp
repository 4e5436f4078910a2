// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>

namespace steadyrest::apps::cli {

/// Options of every verb that reads an NC program.
struct ProgramOptions {
  std::string file;
  std::string dialect;
  std::string tools;         ///< LinuxCNC tool table, empty for none
  std::string variables;     ///< LinuxCNC variable file, empty for none
  std::string units = "mm";  ///< of those files
  std::string start_units;   ///< in force at the program's start; empty: the machine file's
  std::string axes = "XYZABC";
  std::vector<std::string> subprograms;  ///< folders; empty: the program's own
  bool block_delete = false;
  bool least_increment = false;
  bool strict = false;  ///< what is not understood refuses the program
};

/// Adds FILE, --dialect and the options of the control's data.
void add_program_options(Verb& verb, ProgramOptions& options);
/// The same for a verb that has a machine file: dialect and axes are the machine's, --dialect may
/// still override.
void add_machine_program_options(Verb& verb, ProgramOptions& options);
/// The same for a verb with an optional program: --program, and the options that only apply to one.
void add_optional_program(Verb& verb, ProgramOptions& options, const std::string& description);
/// Adds -o, the file of the changed program.
void add_changed_program(Verb& verb, std::string& output);

/// The interpreter's configuration; reads the files that the options name.
[[nodiscard]] kernel::outcome::Result<nc::interpret::Config> program_config(
    const ProgramOptions& options);
[[nodiscard]] kernel::outcome::Result<nc::interpret::Config> program_config(
    const ProgramOptions& options, const kernel::machine::Machine& machine);

/// The key `assumed[]` (`line`, `what`, `text`): what the program leaves to settings of the control
/// that are not known. The text for people, empty for none.
std::string put_assumed(Answer& answer, const nc::interpret::Report& report);
/// A program that would be rewritten on an assumption is refused.
[[nodiscard]] kernel::outcome::Result<void> no_assumption(const nc::interpret::Report& report,
                                                          const std::string& file);
/// The same for a program that nothing has read yet. One that is refused is left to its reader.
[[nodiscard]] kernel::outcome::Result<void> no_assumption(const std::string& file,
                                                          const nc::interpret::Config& config);
/// The key `assumed[]` (`line`, `name`, `value`): what the program reads of values that the control
/// decides, and what was taken for them; the first ten as notes.
void put_unknown(Answer& answer, const std::vector<nc::interpret::Assumed>& assumed);
/// The keys `opaque[]` (`line`, `last_line`, null while open, `word`, `reason`, `text`, `file`) and
/// `opaque_blocks`: what is not understood, and how far it reaches; the first ten words as notes.
void put_opaque(Answer& answer, const nc::interpret::Report& report);
/// Runs a program; how much of its file is read is shown.
[[nodiscard]] kernel::outcome::Result<nc::interpret::Report> run_program(
    const std::string& path, const nc::interpret::Config& config, nc::interpret::Sink& sink,
    Progress& progress);

/// The keys `blocks` and `refused[]`, the refusals for stderr and the exit code.
void put_report(Answer& answer, const nc::interpret::Report& report, const std::string& file);
/// After put_report(), where the machine file chose the dialect: reports that, and which one.
void say_dialect(Answer& answer, const ProgramOptions& options,
                 const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli
