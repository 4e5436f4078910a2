// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Reader of the process file: TOML text → `Process` in internal units.
///
/// Sections [tool], [cut], [[mode]] and [[frf]] (a measured response, fitted to modes at once:
/// mode_fit.hpp; its path is relative to the process file's folder); every key with its unit, range
/// and default: README.md of the room. A mode has its mass_kg or its stiffness_N_um (m = k/ω²), and
/// its axis or the angle from x towards y at which it vibrates (shape (cos, sin): cross terms). An
/// invalid value is never repaired: the file is refused with line, value seen, what is allowed and
/// what to do. Nothing throws.
namespace steadyrest::chatter::offline {

/// Reads a file. The first fault is the refusal.
[[nodiscard]] kernel::outcome::Result<Process> read_process(const std::string& path);

/// Reads a text; `file` is its name in refusals.
[[nodiscard]] kernel::outcome::Result<Process> parse_process(std::string_view text,
                                                             const std::string& file);

/// The same, with all faults of the file in line order; never empty when refused.
using ProcessOrFaults = std::expected<Process, std::vector<kernel::outcome::Refusal>>;
[[nodiscard]] ProcessOrFaults read_process_all_faults(const std::string& path);
[[nodiscard]] ProcessOrFaults parse_process_all_faults(std::string_view text,
                                                       const std::string& file);

/// The files of the [[frf]] sections as read_process() opens them; none if the file cannot be read.
[[nodiscard]] std::vector<std::string> response_files(const std::string& path);

}  // namespace steadyrest::chatter::offline
