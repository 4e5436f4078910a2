// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace steadyrest::record {

/// `STRY` in the file's head, so that `file` and we know a record from any other database.
inline constexpr std::int64_t kApplication = 0x53545259;
/// Raised by every change to the tables or columns.
inline constexpr std::int64_t kFormat = 5;
/// The oldest that is still read: it has no wishes.
inline constexpr std::int64_t kOldestFormat = 2;
/// The first with `run.listener`.
inline constexpr std::int64_t kListenerFormat = 4;
/// The first that knows of programs whose text corrects the path: those columns are the last of a
/// segment.
inline constexpr std::int64_t kOriginalFormat = 5;
inline constexpr std::size_t kOriginalFields = 3;

/// Of the bits of `run.capability`: the delay of the path offset in µs lies above the others, its
/// acceleration in mm/s² above that.
inline constexpr int kDelayShift = 16;
inline constexpr int kAccelerationShift = 32;

/// How a record is written: a power cut costs no more than the last transactions.
inline constexpr const char* kWriting = "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL";

/// README.md explains the tables.
inline constexpr const char* kSchema = R"(
PRAGMA application_id = 1398035033;
PRAGMA user_version = 5;
CREATE TABLE run (
  start_utc TEXT NOT NULL, version TEXT NOT NULL, machine TEXT NOT NULL,
  machine_text TEXT NOT NULL, program TEXT NOT NULL, program_text TEXT NOT NULL,
  cycle_s REAL NOT NULL, capability INTEGER NOT NULL, listener TEXT NOT NULL);
CREATE TABLE totals (samples INTEGER NOT NULL, dropped INTEGER NOT NULL, closed INTEGER NOT NULL);
INSERT INTO totals VALUES (0, 0, 0);
CREATE TABLE chunk (
  chunk INTEGER PRIMARY KEY, first_cycle INTEGER NOT NULL, samples INTEGER NOT NULL);
CREATE TABLE chunk_column (
  chunk INTEGER NOT NULL, name TEXT NOT NULL, data BLOB NOT NULL,
  PRIMARY KEY (chunk, name)) WITHOUT ROWID;
CREATE TABLE path (path INTEGER PRIMARY KEY, segments INTEGER NOT NULL);
CREATE TABLE path_part (
  path INTEGER NOT NULL, first INTEGER NOT NULL, segments INTEGER NOT NULL, data BLOB NOT NULL,
  PRIMARY KEY (path, first));
CREATE TABLE event (
  event INTEGER PRIMARY KEY, before INTEGER NOT NULL, time_s REAL, kind INTEGER NOT NULL,
  text TEXT NOT NULL);
)";

}  // namespace steadyrest::record
