// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

/// What is wrong with a command line, after `root` has tried to parse it. An unknown verb or option
/// is reported with the nearest known one, before anything that is missing because of it.
[[nodiscard]] kernel::outcome::Refusal usage_refusal(const CLI::App& root,
                                                     const CLI::ParseError& error);

}  // namespace steadyrest::apps::cli
