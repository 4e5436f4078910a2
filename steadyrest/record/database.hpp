// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace steadyrest::record {

/// A prepared statement. Parameters and columns count from 0; texts and blobs live until the next
/// step.
class Statement {
 public:
  Statement& bind(int at, std::int64_t value) noexcept;
  Statement& bind(int at, double value) noexcept;
  Statement& bind(int at, std::string_view text) noexcept;
  Statement& bind(int at, std::span<const std::byte> blob) noexcept;
  /// Runs to the next row: false after the last one, ready to be bound again.
  kernel::outcome::Result<bool> step() noexcept;
  /// Ends a query before its last row.
  void reset() noexcept;
  /// Runs a statement that gives no rows.
  kernel::outcome::Result<void> run() noexcept;

  [[nodiscard]] std::int64_t integer(int at) const noexcept;
  [[nodiscard]] double real(int at) const noexcept;
  [[nodiscard]] std::string text(int at) const;
  [[nodiscard]] std::span<const std::byte> blob(int at) const noexcept;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  Statement(sqlite3_stmt* statement, std::string file)
      : statement_(statement), file_(std::move(file)) {}

  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  std::string file_;
};

/// An SQLite file. Errors are refusals that name the file.
class Database {
 public:
  /// Makes the file; refuses one that exists.
  /// Refused: no name, or one that a file has.
  static kernel::outcome::Result<void> check_new(const std::string& file);
  static kernel::outcome::Result<Database> create(const std::string& file);
  /// For reading. A file that is no database is refused by the first statement.
  static kernel::outcome::Result<Database> open(const std::string& file);
  static kernel::outcome::Result<Database> open_to_change(const std::string& file);

  /// Runs statements without parameters and rows.
  kernel::outcome::Result<void> run(const char* sql) noexcept;
  [[nodiscard]] kernel::outcome::Result<Statement> prepare(const char* sql);
  /// The first column of the first row.
  [[nodiscard]] kernel::outcome::Result<std::int64_t> number(const char* sql);

 private:
  struct Close {
    void operator()(sqlite3* database) const noexcept;
  };
  static kernel::outcome::Result<Database> open(const std::string& file, int flags);
  Database() = default;

  std::unique_ptr<sqlite3, Close> database_;
  std::string file_;
};

}  // namespace steadyrest::record
