// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ranges>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/past_runs/course.hpp>
#include <steadyrest/apps/live_page/past_runs/event_words.hpp>
#include <steadyrest/apps/live_page/past_runs/export.hpp>
#include <steadyrest/apps/live_page/records.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/trial/replay/replay.hpp>
#include <steadyrest/web/gate.hpp>

namespace steadyrest::apps::live_page {
namespace {

namespace fs = std::filesystem;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using past_runs::CourseAsked;
using record::RecordReader;
using record::RunFile;

constexpr double kLongest_s = 1e9;  ///< 30 years
constexpr std::size_t kMostShown = 40;

web::Response no_record(const std::string& name) {
  return web::error(404, "not_found", fmt::format("there is no record {}", name),
                    "choose one of the list");
}

web::Response unreadable(const Refusal& refusal) {
  return web::error(422, "refused", refusal.what, refusal.to_do);
}

Result<std::vector<RunFile>> files_of(const Desk& desk) {
  return desk.records.empty() ? Result<std::vector<RunFile>>() : record::run_files(desk.records);
}

std::string name_of(const std::string& file) {
  return fs::path(file).filename();
}

/// The file of this name in the folder; none for anything that is no plain name.
std::optional<std::string> file_of(const Desk& desk, const std::string& name) {
  for (const RunFile& at : files_of(desk).value_or(std::vector<RunFile>())) {
    if (name_of(at.file) == name) {
      return at.file;
    }
  }
  return std::nullopt;
}

/// By this run, or by another one that still goes on.
bool is_written(const Desk& desk, const std::string& file, const RecordReader& reader) {
  return !reader.totals().closed &&
         ((desk.writing && name_of(file) == desk.writing()) || record::written_lately(file));
}

Json json_of(const Desk& desk, const RunFile& file, const RecordReader& reader) {
  const auto& run = reader.run();
  const auto& totals = reader.totals();
  const std::string name = name_of(file.file);
  return {{"name", name},
          {"start_utc", run.start_utc},
          {"machine", run.machine},
          {"program", run.program},
          {"seconds", static_cast<double>(totals.samples) * run.cycle_s},
          {"samples", totals.samples},
          {"bytes", file.bytes},
          {"closed", totals.closed},
          {"writing", is_written(desk, file.file, reader)},
          {"fault", name.starts_with("fault-")}};
}

/// What the list shows of a file; null: nothing. One that was written just now may be a record that
/// another run is beginning.
Json row_of(const Desk& desk, const RunFile& file, const std::string& words) {
  const auto reader = RecordReader::open(file.file);
  std::error_code fault;
  if (!reader && (!fs::exists(file.file, fault) || record::written_lately(file.file))) {
    return nullptr;
  }
  const std::string name = name_of(file.file);
  const std::string searched =
      reader ? name + "\n" + reader->run().machine + "\n" + reader->run().program : name;
  if (web::lower(searched).find(words) == std::string::npos) {
    return nullptr;
  }
  return reader ? json_of(desk, file, *reader)
                : Json{{"name", name}, {"bytes", file.bytes}, {"damaged", reader.error().what}};
}

/// A number of the query; `otherwise` where it is not given.
Result<double> number(const Query& query, const char* key, double least, double most,
                      double otherwise) {
  const auto at = query.find(key);
  if (at == query.end()) {
    return otherwise;
  }
  const std::string& text = at->second;
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc() && read.ptr == text.data() + text.size() && value >= least &&
      value <= most) {
    return value;
  }
  return refuse(fmt::format("`{}` is {}; allowed: {:.0f} … {:.0f}", key,
                            text.empty() ? "empty" : text.substr(0, kMostShown), least, most),
                "give a number in that range");
}

/// The stretch that is asked for.
Result<CourseAsked> course_asked(const std::string& file, const Query& query) {
  CourseAsked out{.file = file};
  const auto from_s = number(query, "from_s", 0.0, kLongest_s, out.from_s);
  const auto to_s = number(query, "to_s", 0.0, kLongest_s, out.to_s);
  const auto points =
      number(query, "points", 1.0, CourseAsked::kMostPoints, static_cast<double>(out.points));
  for (const auto* const given : {&from_s, &to_s, &points}) {
    if (!*given) {
      return std::unexpected(given->error());
    }
  }
  if (*from_s >= *to_s) {
    return refuse(
        fmt::format("`from_s` is {} and `to_s` {}; allowed: from_s < to_s", *from_s, *to_s),
        "give a `to_s` above `from_s`");
  }
  if (*points != std::floor(*points)) {
    return refuse(fmt::format("`points` is {}; allowed: a whole number", *points), "round it");
  }
  out.from_s = *from_s;
  out.to_s = *to_s;
  out.points = static_cast<std::size_t>(*points);
  return out;
}

web::Response details(const Desk& desk, const std::string& file, const std::string& name) {
  const auto reader = RecordReader::open(file);
  if (!reader) {
    return unreadable(reader.error());
  }
  const auto& run = reader->run();
  const auto& totals = reader->totals();
  Json events = Json::array();
  for (const record::Event& event : reader->events()) {
    events.push_back({{"t_s", event.time_s},
                      {"kind", record::word(event.kind)},
                      {"text", past_runs::event_words(event)}});
  }
  return answer({{"record",
                  {{"run",
                    {{"name", name},
                     {"start_utc", run.start_utc},
                     {"version", run.version},
                     {"machine", run.machine},
                     {"program", run.program},
                     {"cycle_s", run.cycle_s}}},
                   {"totals",
                    {{"samples", totals.samples},
                     {"seconds", static_cast<double>(totals.samples) * run.cycle_s},
                     {"dropped", totals.dropped},
                     {"closed", totals.closed},
                     {"writing", is_written(desk, file, *reader)}}},
                   {"events", std::move(events)},
                   {"formats", past_runs::export_formats()}}}});
}

web::Response data(const std::string& file, past_runs::Overviews& overviews,
                   const RecordAsked& asked) {
  const auto stretch = course_asked(file, asked.query);
  if (!stretch) {
    return web::error(400, "bad_request", stretch.error().what, stretch.error().to_do);
  }
  const auto course = past_runs::course_of(*stretch, overviews, asked.stop);
  return course ? answer(*course) : unreadable(course.error());
}

web::Response download(const std::string& file, const std::string& name, const RecordAsked& asked) {
  const auto format = asked.query.find("format");
  return past_runs::export_record(
      {.file = file,
       .name = name,
       .format = format == asked.query.end() ? std::string() : format->second},
      asked.stop);
}

}  // namespace

web::Response list_records(const Desk& desk, const Query& query, const std::stop_token& stop) {
  const auto files = files_of(desk);
  if (!files) {
    return unreadable(files.error());
  }
  const auto search = query.find("search");
  const std::string words = search != query.end() ? web::lower(search->second) : "";
  Json list = Json::array();
  for (const RunFile& file : *files | std::views::reverse) {
    if (stop.stop_requested()) {
      break;
    }
    if (Json row = row_of(desk, file, words); !row.is_null()) {
      list.push_back(std::move(row));
    }
  }
  return answer({{"folder", !desk.records.empty()}, {"records", std::move(list)}});
}

web::Response show_record(const Desk& desk, past_runs::Overviews& overviews,
                          const RecordAsked& asked) {
  const std::size_t slash = asked.rest.find('/');
  const std::string name = asked.rest.substr(0, slash);
  const std::string what = slash == std::string::npos ? "" : asked.rest.substr(slash + 1);
  const auto file = file_of(desk, name);
  if (!file) {
    return no_record(name);
  }
  if (what.empty()) {
    return details(desk, *file, name);
  }
  if (what == "data") {
    return data(*file, overviews, asked);
  }
  return what == "export" ? download(*file, name, asked) : no_record(asked.rest);
}

web::Response replay_record(const Desk& desk, const std::string& name,
                            const std::stop_token& stop) {
  const auto file = file_of(desk, name);
  if (!file) {
    return no_record(name);
  }
  const auto reader = RecordReader::open(*file);
  if (!reader) {
    return unreadable(reader.error());
  }
  const auto machine = passport::parse(reader->run().machine_text, name);
  if (!machine) {
    return unreadable(machine.error());
  }
  const auto replayed = trial::replay::replay(
      *file, *machine, [&stop](double /*share*/) { return !stop.stop_requested(); });
  if (!replayed) {
    return unreadable(replayed.error());
  }
  Json first;
  Json fields = Json::array();
  if (const auto& difference = replayed->first_difference) {
    first = difference->cycle;
    fields = difference->fields;
  }
  return answer({{"cycles", replayed->cycles},
                 {"different", replayed->different},
                 {"first_difference", first},
                 {"fields", std::move(fields)}});
}

}  // namespace steadyrest::apps::live_page
