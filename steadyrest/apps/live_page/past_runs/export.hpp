// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include <steadyrest/web/message.hpp>

namespace steadyrest::apps::live_page::past_runs {

struct ExportAsked {
  std::string file;
  std::string name;            ///< of the record, for the one who saves it
  std::string format;          ///< csv, hdf5, sqlite; empty: sqlite
  double most_bytes = 8.0e9;   ///< of the table
  double share_of_room = 0.5;  ///< of the room on the disk, which the running record needs too
};

/// What this program can write: `sqlite`, `csv` and, where it was built with it, `hdf5`.
[[nodiscard]] std::vector<std::string> export_formats();

/// A record as a file: the record itself, or the table of `steadyrest record export`. It is written
/// beside the record, or in the folder for temporary files where that is not permitted, and is gone
/// once it has been opened to be sent. Refuses an unknown format, HDF5 in a program without it,
/// what takes too much room, and a damaged record.
[[nodiscard]] web::Response export_record(const ExportAsked& asked, const std::stop_token& stop);

}  // namespace steadyrest::apps::live_page::past_runs
