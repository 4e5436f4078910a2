// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/record/database.hpp>
#include <steadyrest/record/sample.hpp>

namespace steadyrest::record {

/// `mode`, `unread`, `undelivered`, `note`, `reload`, `wish`; ends with 0.
[[nodiscard]] std::string_view word(EventKind kind) noexcept;

/// A column of a table that is worked out from a run's samples, given in their order.
struct Derived {
  std::string name;  ///< ends in its unit
  std::function<double(const Sample&)> value;
};

/// Reads a record in order, bit for bit as it was written. A run that is still being written may be
/// read too: as far as it was when open() was called, at least.
class RecordReader {
 public:
  /// Refuses what is no record, has another format, or is damaged.
  static kernel::outcome::Result<RecordReader> open(const std::string& file);

  [[nodiscard]] const RunInfo& run() const noexcept { return run_; }
  [[nodiscard]] const Totals& totals() const noexcept { return totals_; }
  [[nodiscard]] const std::vector<Event>& events() const noexcept { return events_; }
  /// A path is in the file to its last segment: false where the record ended before it was copied.
  [[nodiscard]] bool paths_complete() const noexcept { return paths_complete_; }

  /// The next sample; false after the last. Its frame's vibration lies in `sample` and its path in
  /// this reader. Refuses damaged data.
  kernel::outcome::Result<bool> next(Sample& sample);

 private:
  using Segments = std::vector<kernel::signal::PathSegment>;

  RecordReader(Database database, Statement chunks, Statement columns, std::string file);
  kernel::outcome::Result<void> read_run();
  kernel::outcome::Result<void> read_events();
  kernel::outcome::Result<void> read_paths();
  kernel::outcome::Result<bool> read_chunk();
  kernel::outcome::Result<void> read_columns();
  [[nodiscard]] std::unexpected<kernel::outcome::Refusal> damaged(const std::string& what) const;

  std::string file_;
  std::int64_t format_ = 0;
  Database database_;
  Statement chunks_;
  Statement columns_;
  RunInfo run_;
  Totals totals_;
  std::vector<Event> events_;
  std::map<std::uint32_t, Segments> paths_;
  bool paths_complete_ = true;

  std::vector<std::string> names_;
  std::vector<std::vector<std::uint64_t>> chunk_;  ///< by column
  std::vector<std::uint64_t> vibration_;
  std::int64_t chunk_number_ = 0;
  std::size_t samples_ = 0;  ///< in the chunk
  std::size_t at_ = 0;       ///< next one
  std::size_t vibration_at_ = 0;
};

}  // namespace steadyrest::record
