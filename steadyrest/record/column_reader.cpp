// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/column_reader.hpp>
#include <steadyrest/record/packing.hpp>
#include <steadyrest/record/record_file.hpp>

namespace steadyrest::record {

using kernel::outcome::refuse;
using kernel::outcome::Result;

ColumnReader::ColumnReader(Database database, Statement data, std::string file,
                           std::vector<std::string> names)
    : file_(std::move(file)),
      database_(std::move(database)),
      data_(std::move(data)),
      names_(std::move(names)),
      values_(names_.size()) {}

Result<ColumnReader> ColumnReader::open(const std::string& file, std::vector<std::string> names) {
  auto database = open_record(file);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  auto data = database->prepare("SELECT data FROM chunk_column WHERE chunk = ? AND name = ?");
  if (!data) {
    return std::unexpected(std::move(data.error()));
  }
  ColumnReader reader(std::move(*database), std::move(*data), file, std::move(names));
  if (auto read = reader.read_chunks(); !read) {
    return std::unexpected(std::move(read.error()));
  }
  return reader;
}

Result<void> ColumnReader::read_chunks() {
  auto run = database_.prepare("SELECT cycle_s FROM run");
  auto query = database_.prepare("SELECT chunk, first_cycle, samples FROM chunk ORDER BY chunk");
  if (!run || !query) {
    return std::unexpected(std::move(run ? query.error() : run.error()));
  }
  if (auto row = run->step(); !row) {
    return std::unexpected(std::move(row.error()));
  }
  cycle_s_ = run->real(0);
  for (;;) {
    const auto row = query->step();
    if (!row) {
      return std::unexpected(row.error());
    }
    if (!*row) {
      return {};
    }
    const std::int64_t samples = query->integer(2);
    if (samples < 1 || samples > kMostInPart) {
      return refuse(file_, fmt::format("is damaged: chunk {} has no samples", query->integer(0)),
                    "restore it from a copy, or delete it");
    }
    chunks_.push_back({.number = query->integer(0),
                       .first_cycle = static_cast<std::uint64_t>(query->integer(1)),
                       .samples = static_cast<std::size_t>(samples)});
  }
}

Result<void> ColumnReader::read(std::size_t index) {
  const Chunk& chunk = chunks_[index];
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto row = data_.bind(0, chunk.number).bind(1, std::string_view(names_[i])).step();
    if (!row) {
      return std::unexpected(row.error());
    }
    const auto bits = *row ? unpack(data_.blob(0), chunk.samples) : std::nullopt;
    data_.reset();
    if (!bits) {
      return refuse(file_,
                    fmt::format("is damaged: column {} of chunk {}", names_[i], chunk.number),
                    "restore it from a copy, or delete it");
    }
    values_[i].resize(bits->size());
    for (std::size_t k = 0; k < bits->size(); ++k) {
      values_[i][k] = std::bit_cast<double>((*bits)[k]);
    }
  }
  return {};
}

}  // namespace steadyrest::record
