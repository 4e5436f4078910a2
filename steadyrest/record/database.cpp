// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <utility>

#include <sqlite3.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/database.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;

/// After a writer that was killed the first reader recovers its log, and the others wait for that.
constexpr int kMostWait_ms = 10'000;

Refusal fault(sqlite3* database, const std::string& file) {
  const int code = sqlite3_errcode(database);
  const std::string said = sqlite3_errmsg(database);
  switch (code & 0xFF) {
    case SQLITE_NOTADB:
      return kernel::outcome::bad_input(file, "is no record of a run",
                                        "name a file that Steadyrest has recorded");
    case SQLITE_CORRUPT:
      return kernel::outcome::bad_input(file, "is damaged: " + said,
                                        "restore it from a copy, or delete it");
    case SQLITE_FULL:
      return {Kind::unavailable, file, 0, "the disk is full",
              "free space, or name a folder on another disk with --record"};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {Kind::unavailable, file, 0, "is locked by another program", "close that program"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return {Kind::unavailable, file, 0, "cannot be opened: " + said,
              "check the name and the permissions of file and folder"};
    default:
      return {Kind::unavailable, file, 0, "cannot be read or written: " + said, "check the disk"};
  }
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

// What cannot be bound, for want of memory, is NULL, which the schema refuses.
Statement& Statement::bind(int at, std::int64_t value) noexcept {
  sqlite3_bind_int64(statement_.get(), at + 1, value);
  return *this;
}

Statement& Statement::bind(int at, double value) noexcept {
  sqlite3_bind_double(statement_.get(), at + 1, value);
  return *this;
}

Statement& Statement::bind(int at, std::string_view text) noexcept {
  sqlite3_bind_text64(statement_.get(), at + 1, text.empty() ? "" : text.data(), text.size(),
                      SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind(int at, std::span<const std::byte> blob) noexcept {
  sqlite3_bind_blob64(statement_.get(), at + 1, blob.data(), blob.size(), SQLITE_TRANSIENT);
  return *this;
}

Result<bool> Statement::step() noexcept {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) {
    return true;
  }
  sqlite3* const database = sqlite3_db_handle(statement_.get());
  if (code != SQLITE_DONE) {
    Refusal refusal = fault(database, file_);
    sqlite3_reset(statement_.get());
    return std::unexpected(std::move(refusal));
  }
  sqlite3_reset(statement_.get());
  return false;
}

void Statement::reset() noexcept {
  sqlite3_reset(statement_.get());
}

Result<void> Statement::run() noexcept {
  if (auto done = step(); !done) {
    return std::unexpected(std::move(done.error()));
  }
  return {};
}

std::int64_t Statement::integer(int at) const noexcept {
  return sqlite3_column_int64(statement_.get(), at);
}

double Statement::real(int at) const noexcept {
  return sqlite3_column_double(statement_.get(), at);
}

std::string Statement::text(int at) const {
  const std::span<const std::byte> bytes = blob(at);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> Statement::blob(int at) const noexcept {
  const void* const data = sqlite3_column_blob(statement_.get(), at);
  const int size = sqlite3_column_bytes(statement_.get(), at);
  return {static_cast<const std::byte*>(data), static_cast<std::size_t>(size)};
}

void Database::Close::operator()(sqlite3* database) const noexcept {
  sqlite3_close_v2(database);
}

Result<Database> Database::open(const std::string& file, int flags) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &opened, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database;
  database.database_.reset(opened);
  database.file_ = file;
  if (code != SQLITE_OK) {
    return std::unexpected(fault(opened, file));
  }
  sqlite3_extended_result_codes(opened, 1);
  return database;
}

Result<void> Database::check_new(const std::string& file) {
  std::error_code error;
  if (file.empty() || std::filesystem::exists(file, error)) {
    return refuse(file, file.empty() ? "a record needs a name" : "the file exists",
                  "give the record another name");
  }
  return {};
}

Result<Database> Database::create(const std::string& file) {
  if (auto is_new = check_new(file); !is_new) {
    return std::unexpected(std::move(is_new.error()));
  }
  return open(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
}

Result<Database> Database::open(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return refuse(file,
                  std::filesystem::exists(file, error) ? "is not a file" : "there is no such file",
                  "name a file that Steadyrest has recorded");
  }
  auto database = open(file, SQLITE_OPEN_READONLY);
  if (database) {
    sqlite3_busy_timeout(database->database_.get(), kMostWait_ms);
  }
  return database;
}

Result<Database> Database::open_to_change(const std::string& file) {
  return open(file, SQLITE_OPEN_READWRITE);
}

Result<void> Database::run(const char* sql) noexcept {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    return std::unexpected(fault(database_.get(), file_));
  }
  return {};
}

Result<Statement> Database::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    return std::unexpected(fault(database_.get(), file_));
  }
  return Statement(statement, file_);
}

Result<std::int64_t> Database::number(const char* sql) {
  auto statement = prepare(sql);
  if (!statement) {
    return std::unexpected(std::move(statement.error()));
  }
  if (auto row = statement->step(); !row) {
    return std::unexpected(std::move(row.error()));
  }
  return statement->integer(0);
}

}  // namespace steadyrest::record
