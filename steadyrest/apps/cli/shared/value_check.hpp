// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace steadyrest::apps::cli {

/// What all options ask of what is given: something, and where a number is wanted a whole decimal
/// one (`0x10`, `010` and `1,5` are none), finite, and not below 0 where it counts.
void check_value(CLI::Option& option);

/// The range of a number, ends included; the help shows it.
[[nodiscard]] CLI::Validator within(double least, double most);

/// For a verb that only calculates: each number of its options lies between 1e-9 and 1e12, so that
/// no result leaves what a number holds.
void check_size(CLI::App& verb);

}  // namespace steadyrest::apps::cli
