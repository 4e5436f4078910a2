// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include <steadyrest/apps/cli/record/verb_record_export.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/record_reader.hpp>

namespace steadyrest::apps::cli {
namespace record_export {
namespace {

using record::ColumnName;

constexpr const char* kHead = "number,path,vibrations,time_s";

struct Options {
  std::string record;
  std::string output;
};

std::string head(record::Sample& sample) {
  std::string line;
  record::sample_columns(sample, [&line](const ColumnName& name, auto& /*value*/) {
    line += (line.empty() ? "" : ",") + name.text();
  });
  return line + "\n";
}

/// Each number as the shortest text that reads back as the same; enumerations and yes/no as
/// numbers.
void put_row(record::Sample& sample, std::string& line) {
  line.clear();
  record::sample_columns(sample, [&line](const ColumnName& /*name*/, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if (!line.empty()) {
      line += ',';
    }
    if constexpr (std::is_same_v<Value, double>) {
      fmt::format_to(std::back_inserter(line), "{}", value);
    } else if constexpr (std::is_signed_v<Value>) {
      fmt::format_to(std::back_inserter(line), "{}", std::int64_t{value});
    } else {
      fmt::format_to(std::back_inserter(line), "{}", record::to_bits(value));
    }
  });
  line += '\n';
}

Outcome run(const Options& options, bool json, Progress& progress) {
  auto reader = record::RecordReader::open(options.record);
  if (!reader) {
    return refused(reader.error());
  }
  auto out = table_output(options.output, json);
  if (!out) {
    return refused(out.error());
  }
  const auto sample = std::make_unique<record::Sample>();
  out->write(head(*sample));
  std::uint64_t samples = 0;
  for (std::string line;;) {
    const auto more = reader->next(*sample);
    if (!more) {
      return refused(more.error());
    }
    if (!*more) {
      break;
    }
    put_row(*sample, line);
    out->write(line);
    if (++samples % 1024 == 0) {
      progress.update(static_cast<double>(samples) /
                          static_cast<double>(std::max(reader->totals().samples, samples)),
                      "writing");
    }
  }
  if (const auto written = out->commit(); !written) {
    return refused(written.error());
  }
  Answer answer;
  answer.json["samples"] = samples;
  return answer;
}

}  // namespace
}  // namespace record_export

void add_verb_record_export(Session& session, Verb& verb) {
  auto options = std::make_shared<record_export::Options>();
  verb.reads("record", options->record, "Record of a run (.sqlite)")->required();
  verb.writes("-o,--output", options->output, "Write the table to this file instead of stdout",
              csv_content("a table of a record (CSV)", {record_export::kHead}));
  session.on(verb, [options, &session](Progress& progress) {
    return record_export::run(*options, session.json(), progress);
  });
}

}  // namespace steadyrest::apps::cli
