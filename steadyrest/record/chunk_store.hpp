// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/file/presence.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/database.hpp>
#include <steadyrest/record/sample.hpp>

namespace steadyrest::record {

/// A segment on its way into the record.
struct PathPiece {
  std::uint32_t path = 0;      ///< from 1
  std::uint64_t index = 0;     ///< of the segment
  std::uint64_t segments = 0;  ///< of the whole path
  kernel::signal::PathSegment segment;
};

/// The file side of a record: gathers columns and writes them, a transaction at a time. Belongs to
/// one thread at a time.
class ChunkStore {
 public:
  static kernel::outcome::Result<std::unique_ptr<ChunkStore>> create(const std::string& file,
                                                                     const RunInfo& info);

  void add(Sample& sample);
  void add(PathPiece& piece);
  void add(Event event) { events_.push_back(std::move(event)); }
  [[nodiscard]] std::size_t waiting() const noexcept { return samples_; }
  /// Samples that were added and are in no file: those of a transaction that failed, and all where
  /// the file was removed.
  [[nodiscard]] std::uint64_t lost() const noexcept;
  /// One transaction with all that was added since the last.
  kernel::outcome::Result<void> commit(std::uint64_t dropped);
  /// The last one. Leaves a single file, without SQLite's log beside it.
  kernel::outcome::Result<void> close(std::uint64_t dropped);

 private:
  using Column = std::vector<std::uint64_t>;

  ChunkStore(Database database, const std::string& file);
  static kernel::outcome::Result<void> begin_file(const std::string& file, const RunInfo& info);
  /// SQLite does not notice: the open file goes on taking what is written.
  [[nodiscard]] bool is_removed() const noexcept;
  kernel::outcome::Result<void> check_there() const;
  kernel::outcome::Result<void> prepare();
  kernel::outcome::Result<void> write_all(std::uint64_t dropped, bool closed);
  kernel::outcome::Result<void> write_chunk();
  kernel::outcome::Result<void> write_column(const std::string& name, const Column& column);
  kernel::outcome::Result<void> write_part();
  kernel::outcome::Result<void> write_events();

  Database database_;
  std::string file_;
  kernel::file::Presence there_;
  std::optional<kernel::file::Presence> log_;  ///< SQLite's log, once there is one
  std::vector<Statement> statements_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  Column vibration_;
  std::size_t samples_ = 0;
  std::uint64_t first_cycle_ = 0;
  std::uint64_t stored_ = 0;
  std::uint64_t added_ = 0;
  std::uint64_t committed_ = 0;
  std::int64_t chunk_ = 0;
  std::vector<PathPiece> pieces_;
  std::vector<Event> events_;
};

}  // namespace steadyrest::record
