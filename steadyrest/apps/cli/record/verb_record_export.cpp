// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/apps/cli/record/verb_record_export.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/tables/record_table.hpp>
#include <steadyrest/trial/replay/derived_columns.hpp>

namespace steadyrest::apps::cli {
namespace record_export {
namespace {

struct Options {
  std::string record;
  std::string output;
  std::string format;  ///< empty: by the output's ending
};

bool show(std::uint64_t samples, const record::RecordReader& reader, Progress& progress) {
  if (samples % 1024 == 0) {
    progress.update(static_cast<double>(samples) /
                        static_cast<double>(std::max(reader.totals().samples, samples)),
                    "writing");
  }
  return true;
}

Answer answer_of(std::uint64_t samples) {
  Answer answer;
  answer.json["samples"] = samples;
  return answer;
}

Outcome csv(record::RecordReader& reader, const Options& options, bool json, Progress& progress) {
  auto out = table_output(options.output, json);
  if (!out) {
    return refused(out.error());
  }
  const auto samples = record::tables::write_csv(
      reader, [&out](std::string_view line) { out->write(line); },
      [&](std::uint64_t n) { return show(n, reader, progress); },
      trial::replay::derived_columns(reader.run()));
  if (!samples) {
    return refused(samples.error());
  }
  if (const auto written = out->commit(); !written) {
    return refused(written.error());
  }
  return answer_of(*samples);
}

/// The library writes only to a file; its bytes are then written as every output is.
Outcome hdf5(record::RecordReader& reader, const Options& options, Progress& progress) {
  if (!record::tables::has_hdf5()) {
    return refused(bad_input(options.output, "this program was built without HDF5",
                             "build it with libhdf5-dev installed, or write CSV"));
  }
  auto out = kernel::file::OutputFile::open(options.output);
  if (!out) {
    return refused(out.error());
  }
  const kernel::file::Temporary part(fmt::format("{}.{}.part", options.output, ::getpid()),
                                     kernel::file::Temporary::Kind::file);
  const auto samples = record::tables::write_hdf5(
      reader, part.path(), [&](std::uint64_t n) { return show(n, reader, progress); },
      trial::replay::derived_columns(reader.run()));
  if (!samples) {
    return refused(samples.error());
  }
  std::ifstream bytes(part.path(), std::ios::binary);
  for (std::array<char, 1U << 16U> block{};
       bytes.read(block.data(), block.size()) || bytes.gcount() > 0;) {
    out->write({block.data(), static_cast<std::size_t>(bytes.gcount())});
  }
  if (!bytes.eof()) {
    return refused(bad_input(part.path(), "cannot be read back", "look at the disk"));
  }
  if (const auto written = out->commit(); !written) {
    return refused(written.error());
  }
  return answer_of(*samples);
}

bool is_hdf5(const Options& options) {
  return options.format.empty()
             ? options.output.ends_with(".h5") || options.output.ends_with(".hdf5")
             : options.format == "hdf5";
}

Outcome run(const Options& options, bool json, Progress& progress) {
  if (is_hdf5(options) && options.output.empty()) {
    return refused(bad_input("HDF5 is no text for stdout", "name a file with -o"));
  }
  auto reader = record::RecordReader::open(options.record);
  if (!reader) {
    return refused(reader.error());
  }
  return is_hdf5(options) ? hdf5(*reader, options, progress)
                          : csv(*reader, options, json, progress);
}

}  // namespace
}  // namespace record_export

void add_verb_record_export(Session& session, Verb& verb) {
  auto options = std::make_shared<record_export::Options>();
  verb.reads("record", options->record, "Record of a run (.sqlite)")->required();
  verb.writes(
      "-o,--output", options->output, "Write the table to this file instead of stdout",
      either(csv_content("a table of a record (CSV)", {std::string(record::tables::kCsvHead)}),
             {"an HDF5 file",
              [](std::string_view text) { return text.starts_with("\x89HDF\r\n\x1a\n"); }}));
  verb.add_option("--format", options->format,
                  "csv, or hdf5 with units, events and the machine file; default: hdf5 for a file "
                  "that ends in .h5 or .hdf5, else csv")
      ->check(CLI::IsMember({"csv", "hdf5"}));
  session.on(verb, [options, &session](Progress& progress) {
    return record_export::run(*options, session.json(), progress);
  });
}

}  // namespace steadyrest::apps::cli
