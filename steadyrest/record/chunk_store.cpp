// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>

#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/chunk_store.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/in_turn.hpp>
#include <steadyrest/record/packing.hpp>
#include <steadyrest/record/schema.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

enum Sql : std::uint8_t {
  insert_chunk,
  insert_column,
  insert_path,
  insert_part,
  insert_event,
  update_totals,
  sql_count
};

constexpr const char* kText[sql_count] = {
    "INSERT INTO chunk VALUES (?, ?, ?)",
    "INSERT INTO chunk_column VALUES (?, ?, ?)",
    "INSERT OR IGNORE INTO path VALUES (?, ?)",
    "INSERT INTO path_part VALUES (?, ?, ?, ?)",
    "INSERT INTO event (before, time_s, kind, text) VALUES (?, ?, ?, ?)",
    "UPDATE totals SET samples = ?, dropped = ?, closed = ?",
};

constexpr double kMicrosecond_s = 1e-6;
constexpr const char* kBegun = ".begun";

std::int64_t bits(const kernel::port::Capability& capability) {
  return (capability.feed_override ? 1 : 0) | (capability.spindle_override ? 2 : 0) |
         (capability.axis_offset ? 4 : 0) | (capability.path_offset ? 8 : 0) |
         (capability.latched_word ? 16 : 0) |
         (std::llround(capability.path_offset_delay_s / kMicrosecond_s) << kDelayShift) |
         (std::llround(capability.path_offset_acceleration_mm_s2) << kAccelerationShift);
}

Result<void> write_run(Database& database, const RunInfo& info) {
  auto insert = database.prepare("INSERT INTO run VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  if (!insert) {
    return std::unexpected(std::move(insert.error()));
  }
  int at = 0;
  for (const std::string* text : {&info.start_utc, &info.version, &info.machine, &info.machine_text,
                                  &info.program, &info.program_text}) {
    insert->bind(at++, *text);
  }
  return insert->bind(6, info.cycle_s).bind(7, bits(info.capability)).bind(8, info.listener).run();
}

}  // namespace

ChunkStore::ChunkStore(Database database, const std::string& file)
    : database_(std::move(database)), file_(file), there_(file) {}

/// Under another name until it says what is recorded: a layer that is killed as it starts leaves no
/// record that cannot be read.
Result<void> ChunkStore::begin_file(const std::string& file, const RunInfo& info) {
  const std::string begun = file + kBegun;
  std::error_code fault;
  for (const char* const beside : {"", "-journal", "-wal", "-shm"}) {
    std::filesystem::remove(begun + beside, fault);
  }
  auto database = Database::create(begun);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  // The change to a log goes by a journal, which a reader that must not write cannot play back.
  return in_turn([&] { return database->run(kWriting); }, [&] { return database->run("BEGIN"); },
                 [&] { return database->run(kSchema); }, [&] { return write_run(*database, info); },
                 [&] { return database->run("COMMIT"); });
}

Result<std::unique_ptr<ChunkStore>> ChunkStore::create(const std::string& file,
                                                       const RunInfo& info) {
  if (auto free = Database::check_new(file); !free) {
    return std::unexpected(std::move(free.error()));
  }
  const kernel::file::Temporary begun(file + kBegun, kernel::file::Temporary::Kind::file);
  if (auto made = begin_file(file, info); !made) {
    made.error().file = file;
    return std::unexpected(std::move(made.error()));
  }
  // Not over a file that has come there since.
  const bool named =
      ::renameat2(AT_FDCWD, begun.path().c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE) == 0 ||
      (errno == EINVAL && ::rename(begun.path().c_str(), file.c_str()) == 0);
  if (!named) {
    return refuse(file, std::string("cannot be made: ") + std::strerror(errno),
                  "check the permissions of the folder");
  }
  auto database = Database::open_to_change(file);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  std::unique_ptr<ChunkStore> store(new ChunkStore(std::move(*database), file));
  if (auto ready =
          in_turn([&] { return store->database_.run(kWriting); }, [&] { return store->prepare(); });
      !ready) {
    return std::unexpected(std::move(ready.error()));
  }
  return store;
}

bool ChunkStore::is_removed() const noexcept {
  return there_.is_removed() || (log_ && log_->is_removed());
}

Result<void> ChunkStore::check_there() const {
  if (is_removed()) {
    return kernel::outcome::unavailable(
        file_ + ": was removed while it was written: nothing of this run is kept",
        "start the run again, and leave the folder of its record alone");
  }
  return {};
}

std::uint64_t ChunkStore::lost() const noexcept {
  return added_ - (is_removed() ? 0 : committed_);
}

Result<void> ChunkStore::prepare() {
  for (const char* const text : kText) {
    auto statement = database_.prepare(text);
    if (!statement) {
      return std::unexpected(std::move(statement.error()));
    }
    statements_.push_back(std::move(*statement));
  }
  Sample any;
  sample_columns(
      any, [this](const ColumnName& name, auto& /*value*/) { names_.push_back(name.text()); });
  columns_.resize(names_.size());
  return {};
}

void ChunkStore::add(Sample& sample) {
  ++added_;
  if (samples_++ == 0) {
    first_cycle_ = sample.frame.cycle;
  }
  std::size_t at = 0;
  sample_columns(sample, [&](const ColumnName& /*name*/, auto& value) {
    columns_[at++].push_back(to_bits(value));
  });
  for (std::size_t i = 0; i < sample.vibrations; ++i) {
    vibration_.push_back(to_bits(sample.vibration[i]));
  }
}

void ChunkStore::add(PathPiece& piece) {
  pieces_.push_back(piece);
}

Result<void> ChunkStore::write_column(const std::string& name, const Column& column) {
  const auto data = pack(column);
  return statements_[insert_column].bind(0, chunk_).bind(1, name).bind(2, std::span(data)).run();
}

Result<void> ChunkStore::write_chunk() {
  if (samples_ == 0) {
    return {};
  }
  ++chunk_;
  auto done = statements_[insert_chunk]
                  .bind(0, chunk_)
                  .bind(1, static_cast<std::int64_t>(first_cycle_))
                  .bind(2, static_cast<std::int64_t>(samples_))
                  .run();
  for (std::size_t i = 0; done && i < columns_.size(); ++i) {
    done = write_column(names_[i], columns_[i]);
    columns_[i].clear();
  }
  if (done) {
    done = write_column("vibration", vibration_);
  }
  vibration_.clear();
  stored_ += samples_;
  samples_ = 0;
  return done;
}

/// The pieces of one path at the front.
Result<void> ChunkStore::write_part() {
  const PathPiece first = pieces_.front();
  std::vector<Column> columns;
  std::size_t count = 0;
  for (; count < pieces_.size() && pieces_[count].path == first.path; ++count) {
    std::size_t at = 0;
    segment_columns(pieces_[count].segment, [&](const ColumnName& /*name*/, auto& value) {
      if (at == columns.size()) {
        columns.emplace_back();
      }
      columns[at++].push_back(to_bits(value));
    });
  }
  pieces_.erase(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(count));
  Column all;
  for (const Column& column : columns) {
    all.insert(all.end(), column.begin(), column.end());
  }
  const auto data = pack(all);
  statements_[insert_path]
      .bind(0, std::int64_t{first.path})
      .bind(1, static_cast<std::int64_t>(first.segments));
  statements_[insert_part]
      .bind(0, std::int64_t{first.path})
      .bind(1, static_cast<std::int64_t>(first.index))
      .bind(2, static_cast<std::int64_t>(count))
      .bind(3, std::span(data));
  return in_turn([this] { return statements_[insert_path].run(); },
                 [this] { return statements_[insert_part].run(); });
}

Result<void> ChunkStore::write_events() {
  for (const Event& event : events_) {
    if (auto done = statements_[insert_event]
                        .bind(0, static_cast<std::int64_t>(event.before))
                        .bind(1, event.time_s)
                        .bind(2, static_cast<std::int64_t>(to_bits(event.kind)))
                        .bind(3, event.text)
                        .run();
        !done) {
      return done;
    }
  }
  events_.clear();
  return {};
}

Result<void> ChunkStore::write_all(std::uint64_t dropped, bool closed) {
  auto done = in_turn([this] { return database_.run("BEGIN"); }, [this] { return write_chunk(); });
  while (done && !pieces_.empty()) {
    done = write_part();
  }
  statements_[update_totals]
      .bind(0, static_cast<std::int64_t>(stored_))
      .bind(1, static_cast<std::int64_t>(dropped))
      .bind(2, std::int64_t{closed ? 1 : 0});
  done = in_turn([&done] { return done; }, [this] { return write_events(); },
                 [this] { return statements_[update_totals].run(); },
                 [this] { return database_.run("COMMIT"); }, [this] { return check_there(); });
  committed_ = done ? stored_ : committed_;
  if (done && !log_) {
    log_.emplace(file_ + "-wal");
  }
  return done;
}

Result<void> ChunkStore::commit(std::uint64_t dropped) {
  return write_all(dropped, false);
}

Result<void> ChunkStore::close(std::uint64_t dropped) {
  auto done = write_all(dropped, true);
  statements_.clear();
  if (done) {
    // A reader that has the file open keeps the log in use; then it stays, and nothing is lost.
    [[maybe_unused]] const auto single = database_.run("PRAGMA journal_mode = DELETE");
  }
  return done;
}

}  // namespace steadyrest::record
