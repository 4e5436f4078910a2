// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/apps/live_page/past_runs/export.hpp>
#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/record_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/tables/record_table.hpp>
#include <steadyrest/trial/replay/derived_columns.hpp>
#include <steadyrest/web/gate.hpp>

namespace steadyrest::apps::live_page::past_runs {
namespace {

namespace fs = std::filesystem;
namespace tables = record::tables;
using kernel::file::Temporary;
using kernel::outcome::Refusal;
using record::RecordReader;

constexpr std::uint64_t kBetweenLooks = 1024;  ///< samples

struct Format {
  std::string_view name;
  std::string_view ending;
  std::string_view type;
};
constexpr std::array<Format, 3> kFormats = {{{"sqlite", ".sqlite", "application/vnd.sqlite3"},
                                             {"csv", ".csv", "text/csv; charset=utf-8"},
                                             {"hdf5", ".h5", "application/x-hdf5"}}};

web::Response refused(const Refusal& refusal) {
  return web::error(422, "refused", refusal.what, refusal.to_do);
}

/// A new empty file; none where no folder takes one.
std::shared_ptr<const Temporary> new_file(const std::string& record) {
  std::error_code fault;
  for (const fs::path& folder : {fs::path(record).parent_path(), fs::temp_directory_path(fault)}) {
    std::string name = folder / ".export-XXXXXX";
    if (const int descriptor = ::mkstemp(name.data()); descriptor >= 0) {
      ::close(descriptor);
      return std::make_shared<const Temporary>(std::move(name), Temporary::Kind::file);
    }
  }
  return nullptr;
}

double bytes_of(const std::string& file) {
  std::error_code fault;
  const auto bytes = fs::file_size(file, fault);
  return fault ? 0.0 : static_cast<double>(bytes);
}

double permitted_bytes(const ExportAsked& asked, const std::string& into) {
  std::error_code fault;
  const fs::space_info space = fs::space(into, fault);
  return fault ? asked.most_bytes
               : std::min(asked.most_bytes,
                          asked.share_of_room * static_cast<double>(space.available));
}

web::Response too_large(double most_bytes) {
  return web::error(413, "too_large",
                    fmt::format("the file would have more than {:.0f} MB, which is the room for it",
                                1e-6 * most_bytes),
                    "take SQLite, or run `steadyrest record export` on another disk");
}

/// Nothing where it was written.
std::optional<web::Response> copy(const ExportAsked& asked, const std::string& into) {
  const double most_bytes = permitted_bytes(asked, into);
  if (bytes_of(asked.file) + bytes_of(asked.file + "-wal") > most_bytes) {
    return too_large(most_bytes);
  }
  const auto copied = record::copy_record(asked.file, into);
  return copied ? std::nullopt : std::optional(refused(copied.error()));
}

/// Watches over a table while it grows.
class Watch {
 public:
  Watch(double most_bytes, std::string file, const std::stop_token& stop)
      : most_bytes_(most_bytes), file_(std::move(file)), stop_(stop) {}
  bool goes_on(std::uint64_t samples) {
    if (samples % kBetweenLooks == 0) {
      too_large_ = bytes_of(file_) > most_bytes_;
    }
    return !too_large_ && !stop_.stop_requested();
  }
  [[nodiscard]] bool too_large() const noexcept { return too_large_; }

 private:
  double most_bytes_;
  std::string file_;
  const std::stop_token& stop_;
  bool too_large_ = false;
};

kernel::outcome::Result<std::uint64_t> write(RecordReader& reader, bool hdf5,
                                             const std::string& into, Watch& watch) {
  const auto goes_on = [&watch](std::uint64_t samples) { return watch.goes_on(samples); };
  if (hdf5) {
    return tables::write_hdf5(reader, into, goes_on, trial::replay::derived_columns(reader.run()));
  }
  std::ofstream out(into, std::ios::binary);
  auto samples = tables::write_csv(
      reader, [&out](std::string_view line) { out << line; },
      [&](std::uint64_t n) { return out.good() && goes_on(n); },
      trial::replay::derived_columns(reader.run()));
  out.close();
  if (!out) {
    return kernel::outcome::refuse("the table cannot be written", "look for room on the disk");
  }
  return samples;
}

std::optional<web::Response> table(const ExportAsked& asked, bool hdf5, const std::string& into,
                                   const std::stop_token& stop) {
  auto reader = RecordReader::open(asked.file);
  if (!reader) {
    return refused(reader.error());
  }
  const double most_bytes = permitted_bytes(asked, into);
  if (hdf5) {
    ::unlink(into.c_str());  // the library makes it
  }
  Watch watch(most_bytes, into, stop);
  const auto samples = write(*reader, hdf5, into, watch);
  if (watch.too_large()) {
    return too_large(most_bytes);
  }
  return samples ? std::nullopt : std::optional(refused(samples.error()));
}

}  // namespace

std::vector<std::string> export_formats() {
  std::vector<std::string> out;
  for (const Format& format : kFormats) {
    if (format.name != "hdf5" || tables::has_hdf5()) {
      out.emplace_back(format.name);
    }
  }
  return out;
}

web::Response export_record(const ExportAsked& asked, const std::stop_token& stop) {
  const std::string_view wanted = asked.format.empty() ? "sqlite" : std::string_view(asked.format);
  const auto* const format = std::ranges::find(kFormats, wanted, &Format::name);
  if (format == kFormats.end()) {
    return web::error(422, "refused",
                      fmt::format("format {} is unknown; allowed: csv, hdf5, sqlite", wanted),
                      "give one of these");
  }
  if (wanted == "hdf5" && !tables::has_hdf5()) {
    return web::error(422, "refused", "this program was built without HDF5",
                      "take CSV, or build it with libhdf5-dev installed");
  }
  const auto file = new_file(asked.file);
  if (!file) {
    return web::error(500, "failed", "no file can be made beside the record, nor in /tmp",
                      "see the permissions of these folders");
  }
  auto fault = wanted == "sqlite" ? copy(asked, file->path())
                                  : table(asked, wanted == "hdf5", file->path(), stop);
  if (fault) {
    return std::move(*fault);
  }
  web::Response out;
  out.content_type = format->type;
  out.file = file->path();
  out.keeper = file;
  out.head.emplace_back("Content-Disposition",
                        fmt::format("attachment; filename=\"{}{}\"",
                                    fs::path(asked.name).stem().string(), format->ending));
  return out;
}

}  // namespace steadyrest::apps::live_page::past_runs
