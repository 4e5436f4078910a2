// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/trial/cut/original.hpp>

/// `--against ORIGINAL`: the cut of a changed program, judged by the path of the original.
namespace steadyrest::apps::cli::cut {

/// What a program is judged by whose marks hold its original.
inline constexpr std::string_view kByMarks = "the original that its marks hold";

struct AgainstOptions {
  /// Of the original; empty: the program is judged by the original that its marks hold, else by
  /// its own path.
  std::string file;
  std::optional<double> tube_mm;
};

void add_against_options(Verb& verb, AgainstOptions& options);

/// The original, planned by the same machine with the same data, and held against the changed
/// program; the original that its marks hold without --against; empty where there is none.
[[nodiscard]] std::expected<std::shared_ptr<const trial::cut::Original>, Answer> read_original(
    const AgainstOptions& options, const ProgramOptions& changed, const PathPointer& path,
    const kernel::machine::Machine& machine);

/// The key `against`; returns its text.
[[nodiscard]] std::string put_against(Answer& answer, const AgainstOptions& options,
                                      const trial::cut::Original& original);

}  // namespace steadyrest::apps::cli::cut
