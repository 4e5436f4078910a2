// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/past_runs/course.hpp>
#include <steadyrest/apps/live_page/past_runs/event_words.hpp>
#include <steadyrest/apps/live_page/past_runs/export.hpp>
#include <steadyrest/apps/live_page/records.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/trial/replay/replay.hpp>
#include <steadyrest/web/gate.hpp>

namespace steadyrest::apps::live_page {
namespace {

namespace fs = std::filesystem;
using kernel::outcome::Refusal;
using record::RecordReader;

std::string small(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

web::Response no_record(const std::string& name) {
  return web::error(404, "not_found", fmt::format("there is no record {}", name),
                    "choose one of the list");
}

web::Response unreadable(const Refusal& refusal) {
  return web::error(422, "refused", refusal.what, refusal.to_do);
}

/// The file of this name in the folder; none for anything that is no plain name.
std::optional<std::string> file_of(const Desk& desk, const std::string& name) {
  const auto files = desk.records.empty() ? kernel::outcome::Result<std::vector<record::RunFile>>()
                                          : record::run_files(desk.records);
  if (!files) {
    return std::nullopt;
  }
  for (const record::RunFile& at : *files) {
    if (fs::path(at.file).filename() == name) {
      return at.file;
    }
  }
  return std::nullopt;
}

/// By this run, or by another that still is at it.
bool is_written(const Desk& desk, const std::string& file, const RecordReader& reader) {
  return !reader.totals().closed &&
         ((desk.writing && fs::path(file).filename() == desk.writing()) ||
          record::written_lately(file));
}

Json json_of(const Desk& desk, const record::RunFile& file, const RecordReader& reader) {
  const auto& run = reader.run();
  const auto& totals = reader.totals();
  const std::string name = fs::path(file.file).filename();
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

double number(const Query& query, const char* key, double otherwise) {
  const auto at = query.find(key);
  double value = otherwise;
  if (at != query.end()) {
    std::from_chars(at->second.data(), at->second.data() + at->second.size(), value);
  }
  return std::isfinite(value) ? value : otherwise;
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
  const double points = std::clamp(number(asked.query, "points", 1000.0), 1.0, 4000.0);
  auto course = past_runs::course_of({.file = file,
                                      .from_s = number(asked.query, "from_s", -1e18),
                                      .to_s = number(asked.query, "to_s", 1e18),
                                      .points = static_cast<std::size_t>(points)},
                                     overviews, asked.stop);
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
  Json list = Json::array();
  const auto search = query.find("search");
  const std::string words = search != query.end() ? small(search->second) : "";
  const auto files = desk.records.empty() ? kernel::outcome::Result<std::vector<record::RunFile>>()
                                          : record::run_files(desk.records);
  if (files) {
    for (const record::RunFile& file : *files) {
      if (stop.stop_requested()) {
        break;
      }
      const auto reader = RecordReader::open(file.file);
      if (!reader) {
        continue;  // it may be removed or begun at this moment
      }
      Json entry = json_of(desk, file, *reader);
      const std::string all = small(entry["name"].get<std::string>() + "\n" +
                                    reader->run().machine + "\n" + reader->run().program);
      if (words.empty() || all.find(words) != std::string::npos) {
        list.insert(list.begin(), std::move(entry));  // the newest first
      }
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
