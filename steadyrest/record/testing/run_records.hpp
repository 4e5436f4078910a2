// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/record/run_folder.hpp>

namespace steadyrest::record::testing {

/// The records of whole runs in a folder, the oldest first. A busy computer may have added the last
/// seconds before a burst of overruns: those are left out.
inline std::vector<std::string> run_records(const std::string& folder) {
  std::vector<std::string> records;
  for (const RunFile& file : run_files(folder).value_or(std::vector<RunFile>{})) {
    if (file.rotates) {
      records.push_back(file.file);
    }
  }
  return records;
}

}  // namespace steadyrest::record::testing
