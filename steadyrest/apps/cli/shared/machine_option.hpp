// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::apps::cli {

/// Adds the mandatory `--machine FILE` to a verb.
void add_machine_option(Verb& verb, std::string& path);

/// Reads a machine file; the refusals contain all of its faults.
[[nodiscard]] std::expected<kernel::machine::Machine, Refusals> read_machine(
    const std::string& path);

}  // namespace steadyrest::apps::cli
