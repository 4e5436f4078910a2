// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/in_turn.hpp>
#include <steadyrest/record/packing.hpp>
#include <steadyrest/record/record_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/schema.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::PathSegment;

constexpr std::int64_t kMost = kMostInPart;

constexpr std::int64_t kDelayMask = (1 << (kAccelerationShift - kDelayShift)) - 1;

kernel::port::Capability capability_of(std::int64_t bits) {
  return {.feed_override = (bits & 1) != 0,
          .spindle_override = (bits & 2) != 0,
          .axis_offset = (bits & 4) != 0,
          .path_offset = (bits & 8) != 0,
          .path_offset_delay_s = 1e-6 * static_cast<double>((bits >> kDelayShift) & kDelayMask),
          .path_offset_acceleration_mm_s2 = static_cast<double>(bits >> kAccelerationShift),
          .latched_word = (bits & 16) != 0};
}

/// Of a path in this format.
std::size_t segment_fields(std::int64_t format) {
  PathSegment any;
  std::size_t count = 0;
  segment_columns(any, [&count](const ColumnName& /*name*/, auto& /*value*/) { ++count; });
  return count - (format < kOriginalFormat ? kOriginalFields : 0);
}

/// The columns of a sample that this format does not have keep their defaults.
bool is_later(std::string_view name, std::int64_t format) {
  return format < kOriginalFormat &&
         (name == "original" || name == "original_unknown" || name == "heat_in_text");
}

bool put(const std::vector<std::uint64_t>& values, std::size_t count,
         std::vector<PathSegment>& segments) {
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) {
    PathSegment segment;
    std::size_t at = i;
    segment_columns(segment, [&](const ColumnName& /*name*/, auto& value) {
      good = (at >= values.size() || from_bits(values[at], value)) && good;
      at += count;
    });
    segments.push_back(segment);
  }
  return good;
}

}  // namespace

std::string_view word(EventKind kind) noexcept {
  switch (kind) {
    case EventKind::mode:
      return "mode";
    case EventKind::unread:
      return "unread";
    case EventKind::undelivered:
      return "undelivered";
    case EventKind::reload:
      return "reload";
    case EventKind::wish:
      return "wish";
    case EventKind::note:
      break;
  }
  return "note";
}

RecordReader::RecordReader(Database database, Statement chunks, Statement columns, std::string file)
    : file_(std::move(file)),
      database_(std::move(database)),
      chunks_(std::move(chunks)),
      columns_(std::move(columns)) {
  Sample any;
  sample_columns(
      any, [this](const ColumnName& name, auto& /*value*/) { names_.push_back(name.text()); });
}

std::unexpected<Refusal> RecordReader::damaged(const std::string& what) const {
  return refuse(file_, "is damaged: " + what, "restore it from a copy, or delete it");
}

Result<RecordReader> RecordReader::open(const std::string& file) {
  auto database = open_record(file);
  if (!database) {
    return std::unexpected(std::move(database.error()));
  }
  auto chunks =
      database->prepare("SELECT chunk, samples FROM chunk WHERE chunk > ? ORDER BY chunk");
  if (!chunks) {
    return std::unexpected(std::move(chunks.error()));
  }
  auto columns = database->prepare("SELECT name, data FROM chunk_column WHERE chunk = ?");
  if (!columns) {
    return std::unexpected(std::move(columns.error()));
  }
  RecordReader reader(std::move(*database), std::move(*chunks), std::move(*columns), file);
  if (auto read = in_turn([&] { return reader.read_run(); }, [&] { return reader.read_events(); },
                          [&] { return reader.read_paths(); });
      !read) {
    return std::unexpected(std::move(read.error()));
  }
  return reader;
}

Result<void> RecordReader::read_run() {
  const auto format = database_.number("PRAGMA user_version");
  format_ = format ? *format : kFormat;
  const bool listens = format_ >= kListenerFormat;
  const std::string select =
      std::string(
          "SELECT start_utc, version, machine, machine_text, program, program_text, "
          "cycle_s, capability, samples, dropped, closed, ") +
      (listens ? "listener" : "''") + " FROM run, totals";
  auto query = database_.prepare(select.c_str());
  if (!query) {
    return std::unexpected(std::move(query.error()));
  }
  const auto row = query->step();
  if (!row) {
    return std::unexpected(row.error());
  }
  if (!*row) {
    return damaged("it does not say what was recorded");
  }
  int at = 0;
  for (std::string* text : {&run_.start_utc, &run_.version, &run_.machine, &run_.machine_text,
                            &run_.program, &run_.program_text}) {
    *text = query->text(at++);
  }
  run_.cycle_s = query->real(6);
  run_.capability = capability_of(query->integer(7));
  run_.listener = query->text(11);
  totals_ = {.samples = static_cast<std::uint64_t>(query->integer(8)),
             .dropped = static_cast<std::uint64_t>(query->integer(9)),
             .closed = query->integer(10) != 0};
  return {};
}

Result<void> RecordReader::read_events() {
  auto query = database_.prepare("SELECT before, time_s, kind, text FROM event ORDER BY event");
  if (!query) {
    return std::unexpected(std::move(query.error()));
  }
  for (;;) {
    const auto row = query->step();
    if (!row) {
      return std::unexpected(row.error());
    }
    if (!*row) {
      return {};
    }
    const std::int64_t kind = query->integer(2);
    if (kind < 0 || kind > static_cast<std::int64_t>(to_bits(EventKind::wish))) {
      return damaged("an event of an unknown kind");
    }
    events_.push_back({.before = static_cast<std::uint64_t>(query->integer(0)),
                       .time_s = query->real(1),
                       .kind = static_cast<EventKind>(kind),
                       .text = query->text(3)});
  }
}

Result<void> RecordReader::read_paths() {
  auto query = database_.prepare(
      "SELECT path, path_part.first, path_part.segments, data, path.segments FROM path LEFT JOIN "
      "path_part USING (path) ORDER BY path, path_part.first");
  if (!query) {
    return std::unexpected(std::move(query.error()));
  }
  const std::size_t fields = segment_fields(format_);
  std::map<std::uint32_t, std::int64_t> whole;
  for (;;) {
    const auto row = query->step();
    if (!row) {
      return std::unexpected(row.error());
    }
    if (!*row) {
      break;
    }
    const auto path = static_cast<std::uint32_t>(query->integer(0));
    Segments& segments = paths_[path];
    const std::int64_t count = query->integer(2);
    const auto values = count < 1 || count > kMost
                            ? std::nullopt
                            : unpack(query->blob(3), static_cast<std::size_t>(count) * fields);
    if (!values || std::cmp_not_equal(query->integer(1), segments.size()) ||
        !put(*values, static_cast<std::size_t>(count), segments)) {
      return damaged("path " + std::to_string(path));
    }
    whole[path] = query->integer(4);
  }
  paths_complete_ = std::ranges::all_of(whole, [this](const auto& path) {
    return std::cmp_equal(paths_[path.first].size(), path.second);
  });
  return {};
}

Result<void> RecordReader::read_columns() {
  chunk_.assign(names_.size(), {});
  std::vector<std::byte> vibration;
  bool vibrates = false;
  columns_.bind(0, chunk_number_);
  for (;;) {
    const auto row = columns_.step();
    if (!row) {
      return std::unexpected(row.error());
    }
    if (!*row) {
      break;
    }
    const std::string name = columns_.text(0);
    const auto data = columns_.blob(1);
    if (name == "vibration") {
      vibration.assign(data.begin(), data.end());
      vibrates = true;
      continue;
    }
    const auto at = std::ranges::find(names_, name) - names_.begin();
    auto values = unpack(data, samples_);
    if (std::cmp_equal(at, names_.size()) || !values) {
      return damaged("column " + name + " of chunk " + std::to_string(chunk_number_));
    }
    chunk_[static_cast<std::size_t>(at)] = std::move(*values);
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (is_later(names_[i], format_)) {
      chunk_[i].assign(samples_, 0);
    }
  }
  const auto missing = std::ranges::find_if(chunk_, [](const auto& c) { return c.empty(); });
  if (missing != chunk_.end() || !vibrates) {
    return damaged("a column of chunk " + std::to_string(chunk_number_) + " is missing");
  }
  const auto counts = std::ranges::find(names_, "vibrations") - names_.begin();
  std::size_t readings = 0;
  for (const std::uint64_t count : chunk_[static_cast<std::size_t>(counts)]) {
    readings += std::min<std::uint64_t>(count, kMaxVibration);
  }
  auto values = unpack(vibration, readings);
  if (!values) {
    return damaged("the vibration of chunk " + std::to_string(chunk_number_));
  }
  vibration_ = std::move(*values);
  return {};
}

// By key, not by a cursor that stays open: an open one would keep the writer from tidying its log.
Result<bool> RecordReader::read_chunk() {
  const auto row = chunks_.bind(0, chunk_number_).step();
  if (!row || !*row) {
    return row;
  }
  chunk_number_ = chunks_.integer(0);
  const std::int64_t samples = chunks_.integer(1);
  chunks_.reset();
  if (samples < 1 || samples > kMost) {
    return damaged("chunk " + std::to_string(chunk_number_) + " has no samples");
  }
  samples_ = static_cast<std::size_t>(samples);
  at_ = 0;
  vibration_at_ = 0;
  if (auto read = read_columns(); !read) {
    return std::unexpected(std::move(read.error()));
  }
  return true;
}

Result<bool> RecordReader::next(Sample& sample) {
  if (at_ == samples_) {
    if (auto more = read_chunk(); !more || !*more) {
      return more;
    }
  }
  bool good = true;
  std::size_t column = 0;
  sample_columns(sample, [&](const ColumnName& /*name*/, auto& value) {
    good = from_bits(chunk_[column++][at_], value) && good;
  });
  ++at_;
  if (!good || sample.vibrations > kMaxVibration) {
    return damaged("sample " + std::to_string(sample.number) + " holds an impossible value");
  }
  for (std::size_t i = 0; i < sample.vibrations; ++i) {
    sample.vibration[i] = std::bit_cast<double>(vibration_[vibration_at_++]);
  }
  sample.frame.vibration = std::span(sample.vibration).first(sample.vibrations);
  const auto path = paths_.find(sample.path);
  sample.frame.path = path == paths_.end() ? kernel::signal::PathView{} : path->second;
  const auto original = paths_.find(sample.original);
  sample.frame.original = original == paths_.end() ? kernel::signal::PathView{} : original->second;
  return true;
}

}  // namespace steadyrest::record
