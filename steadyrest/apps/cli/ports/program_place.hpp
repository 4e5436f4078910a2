// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/live/path/program_watch.hpp>

namespace steadyrest::apps::cli::live {

/// The key `program`: file, segments, and where on its path the control is.
[[nodiscard]] Json program_json(const steadyrest::live::ProgramWatch& watch,
                                const steadyrest::live::FollowedPort& port);

/// On stderr, at once: a run may take days.
void warn(const std::string& words) noexcept;

/// Before a machine is connected: a program that is no file of this computer is refused. Empty:
/// none.
[[nodiscard]] std::expected<void, Refusals> check_program_file(const std::string& file);

}  // namespace steadyrest::apps::cli::live
