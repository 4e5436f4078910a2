// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

/// Recorded logs and programs, for tests and benches.
namespace steadyrest::kernel::file::testing {

/// Folder of the third-party data, which is read in place: `$STEADYREST_SHARED_DATA`, else
/// `../shared/data` from the project's root. It may be absent; tests that need it are then skipped.
[[nodiscard]] inline std::filesystem::path shared_data() {
  const char* const set = std::getenv("STEADYREST_SHARED_DATA");
  return set != nullptr ? set : STEADYREST_SOURCE_DIR "/../shared/data";
}

/// A log from our excerpts, which every clone has: tests/recorded/README.md.
[[nodiscard]] inline std::filesystem::path excerpt(const std::string& name) {
  return STEADYREST_SOURCE_DIR "/tests/recorded/" + name + ".csv.gz";
}

}  // namespace steadyrest::kernel::file::testing
