// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::record {

/// `2026-11-26T12:49:34Z`.
[[nodiscard]] std::string utc_now();
/// `run-20261126T124934Z.sqlite` from such a time; the second one in that second, after a run that
/// was killed, is `run-20261126T124934Z-2.sqlite`.
[[nodiscard]] std::string run_name(const std::string& utc, int number = 1);
/// `fault-20260101T124934Z.sqlite`: the last seconds before a fault; the second one in that second
/// is `fault-20260101T124934Z-2.sqlite`.
[[nodiscard]] std::string fault_name(const std::string& utc, int number = 1);

struct RunFile {
  std::string file;         ///< with the folder, as it was given
  std::uint64_t bytes = 0;  ///< with SQLite's log beside it
  bool rotates = false;     ///< has a run's own name; any other name keeps it for good
};

/// The `.sqlite` files of a folder by name: runs in order of time. Refuses what is no folder or
/// cannot be read.
[[nodiscard]] kernel::outcome::Result<std::vector<RunFile>> run_files(const std::string& folder);

/// Whether the file was written to in the last 10 s. A writer commits every second, so a record
/// that was not closed and is not written to has ended with its writer.
[[nodiscard]] bool written_lately(const std::string& file);

/// Removes the oldest runs from the folder of `current` until the rest holds at most `max_bytes`.
/// Never removes `current` or a file with a name that is not run_name()'s. What cannot be removed
/// stays.
void rotate(const std::string& current, std::uint64_t max_bytes);

}  // namespace steadyrest::record
