// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace steadyrest::apps::cli {

/// The common check of all option values: not empty; a number must be decimal throughout (`0x10`,
/// `010` and `1,5` are not), finite, and not below 0 where it counts something.
void check_value(CLI::Option& option);

/// The range of a number, including its ends; the help shows it.
[[nodiscard]] CLI::Validator within(double least, double most);

/// For a verb that only calculates: each number of its options lies between 1e-9 and 1e12, so that
/// no result overflows.
void check_size(CLI::App& verb);

}  // namespace steadyrest::apps::cli
