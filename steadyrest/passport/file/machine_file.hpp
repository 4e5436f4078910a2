// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Reader of the machine file: TOML text → `Machine` in inner units.
///
/// Every key with its unit, range and default: docs/machine-file.md (made from schema.cpp). A value
/// that is not allowed is never repaired: the file is refused with line, value seen, what is
/// allowed and what to do. Nothing throws.
namespace steadyrest::passport {

/// Reads a file. The first fault is the refusal.
[[nodiscard]] kernel::outcome::Result<kernel::machine::Machine> read(const std::string& path);

/// Reads a text; `file` is only its name in refusals.
[[nodiscard]] kernel::outcome::Result<kernel::machine::Machine> parse(std::string_view text,
                                                                      const std::string& file);

/// The same, with all faults of the file in the order of their lines; never empty when refused.
using AllFaults = std::expected<kernel::machine::Machine, std::vector<kernel::outcome::Refusal>>;
[[nodiscard]] AllFaults read_all_faults(const std::string& path);
[[nodiscard]] AllFaults parse_all_faults(std::string_view text, const std::string& file);

}  // namespace steadyrest::passport
