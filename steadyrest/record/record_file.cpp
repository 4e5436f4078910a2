// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/in_turn.hpp>
#include <steadyrest/record/record_file.hpp>
#include <steadyrest/record/schema.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

Result<bool> is_zero(const Result<std::int64_t>& count) {
  return count ? Result<bool>(*count == 0) : std::unexpected(count.error());
}

/// Older versions named the file before they had made its tables.
Result<bool> holds_nothing(Database& database, bool ours) {
  auto nothing = is_zero(database.number("SELECT count(*) FROM sqlite_master"));
  if (nothing && !*nothing && ours) {
    nothing = is_zero(database.number("SELECT count(*) FROM sqlite_master WHERE name = 'chunk'"));
    if (nothing && !*nothing) {
      return is_zero(
          database.number("SELECT (SELECT count(*) FROM run) + (SELECT count(*) FROM chunk)"));
    }
  }
  return nothing;
}

Result<void> check_format(Database& database, const std::string& file) {
  const auto application = database.number("PRAGMA application_id");
  if (!application) {
    return std::unexpected(application.error());
  }
  const auto nothing = holds_nothing(database, *application == kApplication);
  if (!nothing) {
    return std::unexpected(nothing.error());
  }
  if (*nothing) {
    return refuse(file,
                  "holds nothing: the layer that began this record ended before it had written "
                  "anything",
                  "delete it");
  }
  if (*application != kApplication) {
    return refuse(file, "is no record of a run", "name a file that Steadyrest has recorded");
  }
  const auto format = database.number("PRAGMA user_version");
  if (!format) {
    return std::unexpected(format.error());
  }
  if (*format < kOldestFormat || *format > kFormat) {
    return refuse(file,
                  "has format " + std::to_string(*format) + "; this program reads formats " +
                      std::to_string(kOldestFormat) + " to " + std::to_string(kFormat),
                  "use the version of Steadyrest that recorded it");
  }
  return {};
}

/// SQLite sees a missing page only when it is read. While a log lies beside the file, pages may be
/// there.
Result<void> check_size(Database& database, const std::string& file) {
  const auto pages = database.number("PRAGMA page_count");
  const auto page_bytes = database.number("PRAGMA page_size");
  if (!pages || !page_bytes) {
    return std::unexpected(pages ? page_bytes.error() : pages.error());
  }
  std::error_code fault;
  const auto log = std::filesystem::file_size(file + "-wal", fault);
  const bool logged = !fault && log > 0;
  const auto bytes = std::filesystem::file_size(file, fault);
  if (!fault && !logged && std::cmp_less(bytes, *pages * *page_bytes)) {
    return refuse(file, "is damaged: it is cut off", "restore it from a copy, or delete it");
  }
  return {};
}

}  // namespace

Result<Database> open_record(const std::string& file) {
  auto database = Database::open(file);
  if (!database) {
    return database;
  }
  if (auto fit = in_turn([&] { return check_format(*database, file); },
                         [&] { return check_size(*database, file); });
      !fit) {
    return std::unexpected(std::move(fit.error()));
  }
  return database;
}

Result<void> copy_record(const std::string& file, const std::string& copy) {
  auto database = open_record(file);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  auto statement = database->prepare("VACUUM INTO ?");
  if (!statement) {
    return std::unexpected(std::move(statement.error()));
  }
  return statement->bind(0, copy).run();
}

}  // namespace steadyrest::record
