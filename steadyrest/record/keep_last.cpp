// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/record/database.hpp>
#include <steadyrest/record/in_turn.hpp>
#include <steadyrest/record/keep_last.hpp>
#include <steadyrest/record/schema.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Result;

/// Those chunks after which less than the time follows.
constexpr const char* kChunks = R"(
INSERT INTO main.chunk SELECT chunk, first_cycle, samples FROM (
  SELECT *, sum(samples) OVER (ORDER BY chunk DESC) - samples AS following FROM source.chunk)
WHERE following * (SELECT cycle_s FROM source.run) < ?)";

constexpr const char* kRest = R"(
INSERT INTO main.run SELECT * FROM source.run;
INSERT INTO main.chunk_column
  SELECT * FROM source.chunk_column WHERE chunk IN (SELECT chunk FROM main.chunk);
INSERT INTO main.path SELECT * FROM source.path;
INSERT INTO main.path_part SELECT * FROM source.path_part;
INSERT INTO main.event SELECT * FROM source.event;
UPDATE main.totals SET closed = 1, dropped = (SELECT dropped FROM source.totals),
  samples = (SELECT coalesce(sum(samples), 0) FROM main.chunk);
COMMIT;
DETACH source;
PRAGMA journal_mode = DELETE;
)";

Result<void> attach(Database& database, const std::string& run) {
  auto statement = database.prepare("ATTACH ? AS source");
  if (!statement) {
    return std::unexpected(std::move(statement.error()));
  }
  return statement->bind(0, run).run();
}

Result<void> copy_chunks(Database& database, double seconds) {
  auto statement = database.prepare(kChunks);
  if (!statement) {
    return std::unexpected(std::move(statement.error()));
  }
  return statement->bind(0, seconds).run();
}

}  // namespace

Result<void> keep_last(const std::string& run, const std::string& kept, double seconds) {
  auto database = Database::create(kept);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  return in_turn([&] { return database->run(kSchema); }, [&] { return attach(*database, run); },
                 [&] { return database->run("BEGIN"); },
                 [&] { return copy_chunks(*database, seconds); },
                 [&] { return database->run(kRest); });
}

}  // namespace steadyrest::record
