// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/record/verb_record_show.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/live_page/past_runs/event_words.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/record/record_reader.hpp>

namespace steadyrest::apps::cli {
namespace record_show {
namespace {

using kernel::outcome::Reason;

/// Read from the samples themselves.
struct Seen {
  double first_s = 0.0;
  double last_s = 0.0;
  std::uint64_t samples = 0;
  std::uint64_t written = 0;
  std::map<Reason, std::uint64_t> feed_reasons;
};

Result<Seen> look(record::RecordReader& reader, Progress& progress) {
  Seen seen;
  const auto sample = std::make_unique<record::Sample>();
  for (;;) {
    const auto more = reader.next(*sample);
    if (!more) {
      return std::unexpected(more.error());
    }
    if (!*more) {
      return seen;
    }
    seen.first_s = seen.samples == 0 ? sample->frame.time_s : seen.first_s;
    seen.last_s = sample->frame.time_s;
    seen.written += sample->command.write ? 1 : 0;
    ++seen.feed_reasons[sample->command.feed_reason];
    if (++seen.samples % 4096 == 0) {
      progress.update(static_cast<double>(seen.samples) /
                          static_cast<double>(std::max(reader.totals().samples, seen.samples)),
                      "reading");
    }
  }
}

Answer answer_of(const record::RecordReader& reader, const Seen& seen) {
  const auto& run = reader.run();
  const auto& totals = reader.totals();
  Answer answer;
  answer.json = {{"start_utc", run.start_utc},
                 {"version", run.version},
                 {"machine", run.machine},
                 {"program", run.program},
                 {"cycle_ms", 1e3 * run.cycle_s},
                 {"samples", seen.samples},
                 {"dropped", totals.dropped},
                 {"closed", totals.closed},
                 {"paths_complete", reader.paths_complete()},
                 {"first_s", seen.first_s},
                 {"last_s", seen.last_s},
                 {"written", seen.written},
                 {"feed_reasons", Json::object()},
                 {"events", Json::array()}};
  answer.text = fmt::format(
      "{} on {}, {}, Steadyrest {}\n{} cycles of {:.6g} ms from {:.3f} s to {:.3f} s, {} lost; "
      "{}\n",
      run.program, run.machine, run.start_utc, run.version, seen.samples, 1e3 * run.cycle_s,
      seen.first_s, seen.last_s, totals.dropped,
      totals.closed ? "ended in order" : "not ended: killed, or still running");
  Table reasons({"feed", "cycles"});
  for (const auto& [reason, cycles] : seen.feed_reasons) {
    const std::string name(kernel::outcome::name(reason));
    answer.json["feed_reasons"][name] = cycles;
    reasons.row({name, fmt::format("{}", cycles)});
  }
  answer.text += reasons.text();
  for (const record::Event& event : reader.events()) {
    // The whole machine file and the exact values are for --json.
    const std::string words = live_page::past_runs::event_words(event);
    answer.json["events"].push_back({{"time_s", event.time_s},
                                     {"before", event.before},
                                     {"kind", record::word(event.kind)},
                                     {"text", event.text},
                                     {"words", words}});
    answer.text += fmt::format("{:.3f} s {}: {}\n", event.time_s, record::word(event.kind), words);
  }
  return answer;
}

Outcome run(const std::string& file, Progress& progress) {
  auto reader = record::RecordReader::open(file);
  if (!reader) {
    return refused(reader.error());
  }
  const auto seen = look(*reader, progress);
  if (!seen) {
    return refused(seen.error());
  }
  return answer_of(*reader, *seen);
}

}  // namespace
}  // namespace record_show

void add_verb_record_show(Session& session, Verb& verb) {
  auto file = std::make_shared<std::string>();
  verb.reads("record", *file, "Record of a run (.sqlite)")->required();
  session.on(verb, [file](Progress& progress) { return record_show::run(*file, progress); });
}

}  // namespace steadyrest::apps::cli
