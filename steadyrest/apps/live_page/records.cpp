// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/apps/live_page/record_course.hpp>
#include <steadyrest/apps/live_page/records.hpp>
#include <steadyrest/live/wish/wish_words.hpp>
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

Json json_of(const record::RunFile& file, const RecordReader& reader) {
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
          {"fault", name.starts_with("fault-")}};
}

double number(const web::Request& request, const char* key, double otherwise) {
  const auto at = request.query.find(key);
  double value = otherwise;
  if (at != request.query.end()) {
    std::from_chars(at->second.data(), at->second.data() + at->second.size(), value);
  }
  return value;
}

/// The whole machine file is long, and it is not what people look for here.
std::string words_of(const record::Event& event) {
  switch (event.kind) {
    case record::EventKind::reload:
      return "another machine file took over";
    case record::EventKind::wish:
      return steadyrest::live::wish_words(event.text);
    default:
      return event.text;
  }
}

web::Response details(const std::string& file, const std::string& name) {
  const auto reader = RecordReader::open(file);
  if (!reader) {
    return unreadable(reader.error());
  }
  const auto& run = reader->run();
  const auto& totals = reader->totals();
  Json events = Json::array();
  for (const record::Event& event : reader->events()) {
    events.push_back(
        {{"t_s", event.time_s}, {"kind", record::word(event.kind)}, {"text", words_of(event)}});
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
                     {"closed", totals.closed}}},
                   {"events", std::move(events)}}}});
}

web::Response data(const std::string& file, const web::Request& request) {
  const double points = std::clamp(number(request, "points", 1000.0), 1.0, 4000.0);
  auto course = course_of({.file = file,
                           .from_s = number(request, "from_s", -1e18),
                           .to_s = number(request, "to_s", 1e18),
                           .points = static_cast<std::size_t>(points)});
  return course ? answer(*course) : unreadable(course.error());
}

/// A copy that the answer may remove once it is sent: the record itself, whole, which `steadyrest
/// record export` turns into CSV and HDF5.
web::Response download(const std::string& file, const std::string& name) {
  std::string copy = fs::temp_directory_path() / "steadyrest-record-XXXXXX";
  const int descriptor = ::mkstemp(copy.data());
  if (descriptor < 0) {
    return web::error(500, "failed", "there is no room for a copy", "free some space in /tmp");
  }
  ::close(descriptor);
  std::error_code fault;
  fs::copy_file(file, copy, fs::copy_options::overwrite_existing, fault);
  if (fault) {
    fs::remove(copy, fault);
    return web::error(500, "failed", "the record cannot be copied", "see its permissions");
  }
  web::Response out;
  out.content_type = "application/vnd.sqlite3";
  out.file = copy;
  out.head.emplace_back("Content-Disposition", fmt::format("attachment; filename=\"{}\"", name));
  return out;
}

}  // namespace

web::Response list_records(const Desk& desk, const web::Request& request) {
  Json list = Json::array();
  const auto search = request.query.find("search");
  const std::string words = search != request.query.end() ? small(search->second) : "";
  const auto files = desk.records.empty() ? kernel::outcome::Result<std::vector<record::RunFile>>()
                                          : record::run_files(desk.records);
  if (files) {
    for (const record::RunFile& file : *files) {
      const auto reader = RecordReader::open(file.file);
      if (!reader) {
        continue;  // it may be removed or begun at this moment
      }
      Json entry = json_of(file, *reader);
      const std::string all = small(entry["name"].get<std::string>() + "\n" +
                                    reader->run().machine + "\n" + reader->run().program);
      if (words.empty() || all.find(words) != std::string::npos) {
        list.insert(list.begin(), std::move(entry));  // the newest first
      }
    }
  }
  return answer({{"folder", !desk.records.empty()}, {"records", std::move(list)}});
}

web::Response show_record(const Desk& desk, const web::Request& request, const std::string& rest) {
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  const std::string what = slash == std::string::npos ? "" : rest.substr(slash + 1);
  const auto file = file_of(desk, name);
  if (!file) {
    return no_record(name);
  }
  if (what.empty()) {
    return details(*file, name);
  }
  if (what == "data") {
    return data(*file, request);
  }
  return what == "export" ? download(*file, name) : no_record(rest);
}

web::Response replay_record(const Desk& desk, const std::string& name) {
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
  const auto replayed = trial::replay::replay(*file, *machine);
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
