// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/detect_answer.hpp>
#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_detect.hpp>
#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/page/chatter/detect_page.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/plan/speed_table_of.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/offline/signal/signal_speed_name.hpp>
#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
// From a recording to advice. The detector lists the stretches of chatter, then each stretch gets a
// better speed from the best source at hand: the planner (process and depth known) or the deepest
// override step (process known). The frequency alone names the lobes' speeds n = 60·fc/(N·k), but
// whether the cut is stable there it does not say, so none of them is advised.
namespace chatter_detect {
namespace {

namespace offline = chatter::offline;
namespace online = chatter::online;
using kernel::machine::Machine;

constexpr double kMostDepthMm = 10.0;  // of the table, where the cut's depth is not given

struct Options {
  std::string signal;
  std::string machine;
  std::string process;
  std::optional<std::size_t> teeth;
  std::optional<double> speed_rpm;
  std::optional<double> programmed_rpm;
  std::optional<double> depth_mm;
  std::optional<double> rate_hz;
  double edge_rev = 10.0;
  std::string channel;
  std::string speed_pattern;
  std::string report;
  LogOptions format;
};

using Event = DetectEvent;

/// Combinations and ranges that are wrong whatever the files contain.
std::optional<Refusal> unfit(const Options& options) {
  struct Given {
    const char* option;
    const std::optional<double>& value;
  };
  for (const Given& given :
       {Given{"--speed-rpm", options.speed_rpm}, Given{"--programmed-rpm", options.programmed_rpm},
        Given{"--depth-mm", options.depth_mm}, Given{"--rate-hz", options.rate_hz}}) {
    if (given.value && !(*given.value > 0.0 && std::isfinite(*given.value))) {
      return bad_input(fmt::format("{} {} is not above 0", given.option, *given.value),
                       "give a number above 0");
    }
  }
  if (options.teeth && (*options.teeth < 1 || *options.teeth > 64)) {
    return bad_input(fmt::format("--teeth {}; allowed: 1 … 64", *options.teeth),
                     "give the number of teeth, 1 in turning");
  }
  if (!options.teeth && options.process.empty()) {
    return bad_input("the number of teeth is unknown", "give --teeth N or --process FILE");
  }
  if (!(options.edge_rev >= 0.0 && options.edge_rev <= 1000.0)) {
    return bad_input(fmt::format("--edge-revolutions {}; allowed: 0 … 1000", options.edge_rev),
                     "give the revolutions after an entry or exit that its own ringing may last");
  }
  if (options.depth_mm && options.process.empty()) {
    return bad_input("--depth-mm without --process",
                     "give the process file, or leave out the depth");
  }
  return std::nullopt;
}

/// Asks the planner once for speeds within 0.5 % of one another: a plan takes seconds, and the
/// stretches of one recording mostly have one programmed speed.
class AskedPlans {
 public:
  AskedPlans(const offline::Process& process, const Machine& machine, double depth_mm)
      : process_(process), machine_(machine), depth_mm_(depth_mm) {}

  Result<offline::Plan> at(double programmed_rev_s) {
    constexpr double kSame = 0.005;
    for (const auto& [speed, plan] : asked_) {
      if (std::abs(speed - programmed_rev_s) <= kSame * speed) {
        return plan;
      }
    }
    auto plan = offline::plan(process_, machine_, programmed_rev_s, depth_mm_, {});
    if (plan) {
      asked_.emplace_back(programmed_rev_s, *plan);
    }
    return plan;
  }

 private:
  const offline::Process& process_;
  const Machine& machine_;
  double depth_mm_;
  std::vector<std::pair<double, offline::Plan>> asked_;
};

/// The planner's constant step as advice. A `keep` counts as a step too when the cut ran at another
/// override: 100 % is stable, and the recording was not made there. A law is no single speed and is
/// told in words instead.
online::SpeedTable::Advice advice_of(const offline::Plan& plan, double programmed_rev_s,
                                     double present_rev_s) {
  constexpr double kSame = 1e-6;
  online::SpeedTable::Advice out;
  const double speed = plan.chosen.ratio * programmed_rev_s;
  const bool step = plan.decision == offline::PlanDecision::constant ||
                    (plan.decision == offline::PlanDecision::keep &&
                     std::abs(speed - present_rev_s) > kSame * speed);
  if (step) {
    out.request.ratio = plan.chosen.ratio;
    out.speed_rev_s = speed;
    out.limit_depth_mm = plan.chosen.limit_depth_mm.value_or(0.0);
  }
  return out;
}

std::optional<Refusal> advise(const Options& options, const Machine& machine, std::size_t teeth,
                              const std::optional<offline::Process>& process,
                              std::optional<AskedPlans>& plans, Event& event) {
  online::SpeedTable::Config config = offline::steps_of(machine);
  config.teeth = teeth;
  // The override steps are shares of the programmed speed. Without that number the recording is
  // taken as made at 100 %.
  const double programmed = options.programmed_rpm
                                ? kernel::units::rev_s_from_rpm(*options.programmed_rpm)
                                : event.speed_rev_s;
  if (plans) {
    auto plan = plans->at(programmed);
    if (!plan) {
      return plan.error();
    }
    event.advice = advice_of(*plan, programmed, event.speed_rev_s);
    event.plan = std::move(*plan);
    return std::nullopt;
  }
  if (!process) {
    event.lobes_rpm = lobes_rpm(config, programmed, event.frequency_hz);
    return std::nullopt;
  }
  // The depth of cut is unknown, so the table holds each step's limiting depth and the deepest step
  // wins (depth_mm = 0 below requests that).
  if (auto added = offline::add_depths(*process, {programmed}, kMostDepthMm, config); !added) {
    return added.error();
  }
  const auto table = online::SpeedTable::make(std::move(config));
  if (!table) {
    return table.error();
  }
  event.advice = table->ask({.programmed_rev_s = programmed,
                             .ratio = event.speed_rev_s / programmed,
                             .depth_mm = 0.0,
                             .frequency_hz = event.frequency_hz});
  return std::nullopt;
}

/// What the page needs beyond the answer: the recording itself, the teeth for its order lines, and
/// how far up the spectrogram must go.
Json page_of(const Json& answer, const Options& options, const Machine& machine,
             const offline::RecordedSignal& signal, std::size_t teeth, std::size_t window) {
  // The highest chatter frequency sets how far up the page's spectrogram must reach.
  double chatter_hz = 0.0;
  for (const Json& event : answer["events"]) {
    chatter_hz = std::max(chatter_hz, event["frequency_hz"].get<double>());
  }
  return page::detect_page(
      answer,
      {.signal_name = std::filesystem::path(options.signal).filename().string(),
       .machine = machine.name,
       .teeth = teeth,
       .window = window,
       .chatter_hz = chatter_hz},
      signal);
}

/// The channel that heard the first chatter, else the first.
const offline::RecordedSignal& shown_channel(const offline::RecordedChannels& channels,
                                             const std::vector<Event>& events) {
  const std::size_t wanted = events.empty() ? 0 : events.front().channels.front();
  const auto found = std::ranges::find(channels, wanted, &offline::RecordedSignal::channel);
  return found == channels.end() ? channels.front() : *found;
}

DetectAdviser adviser(const Options& options) {
  return options.process.empty() ? DetectAdviser::frequency
         : options.depth_mm      ? DetectAdviser::planner
                                 : DetectAdviser::step;
}

/// The channels to be judged, each with its speed; what was assumed is noted.
Result<offline::RecordedChannels> recording(const Options& options, const Machine& machine,
                                            std::vector<std::string>& notes) {
  GivenSpeeds given{options.speed_rpm, options.programmed_rpm};
  if (!options.speed_pattern.empty()) {
    const auto rpm = offline::speed_rpm_in_name(options.signal, options.speed_pattern);
    if (!rpm) {
      return std::unexpected(rpm.error());
    }
    given.speed_rpm = *rpm;
    given.option = "--speed-from-name";
    notes.push_back(fmt::format("{:.6g} rpm by the file's name", *rpm));
  }
  table::Format format = format_of(options.format);
  if (options.rate_hz) {
    format.sample_hz = *options.rate_hz;
    format.rows_are_samples = true;
  }
  auto read = offline::read_signals(options.signal, format);
  auto channels = read ? chosen_channels(std::move(*read), options.channel, options.signal)
                       : std::unexpected(read.error());
  if (!channels) {
    return channels;
  }
  for (offline::RecordedSignal& signal : *channels) {
    if (auto refusal = set_speed(given, machine, options.signal, signal)) {
      return std::unexpected(std::move(*refusal));
    }
  }
  return channels;
}

/// Reads, listens to each channel, then asks for advice on each stretch.
Outcome detect(const Options& options, const Machine& machine, std::size_t teeth,
               const std::optional<offline::Process>& process, Progress& progress) {
  std::vector<std::string> notes;
  auto channels = recording(options, machine, notes);
  if (!channels) {
    return refused(channels.error());
  }
  auto heard = hear(*channels, teeth, options.edge_rev, options.signal, progress);
  if (!heard) {
    return refused(heard.error());
  }
  std::vector<Event> events;
  std::vector<ChatterEvent> at_edges;
  for (ChatterEvent& event : heard->events) {
    if (event.at == offline::CutPlace::cut) {
      events.push_back({std::move(event), {}, {}, {}});
    } else {
      at_edges.push_back(std::move(event));
    }
  }
  // Plans are made on demand: a quiet recording needs none.
  std::optional<AskedPlans> plans;
  if (process && options.depth_mm) {
    plans.emplace(*process, machine, *options.depth_mm);
  }
  for (Event& event : events) {
    progress.update(1.0, "the better speed");
    if (auto refusal = advise(options, machine, teeth, process, plans, event)) {
      return refused(*refusal);
    }
  }
  notes.insert(notes.end(), heard->notes.begin(), heard->notes.end());
  std::vector<double> modes_hz;
  if (process) {
    std::ranges::transform(process->modes, std::back_inserter(modes_hz),
                           &offline::Mode::frequency_hz);
  }
  Answer answer = detect_answer(*channels, events,
                                {.by = adviser(options),
                                 .modes_hz = std::move(modes_hz),
                                 .sensor = std::move(heard->sensor),
                                 .notes = std::move(notes),
                                 .cuts = std::move(heard->cuts),
                                 .at_edges = std::move(at_edges),
                                 .edge_rev = options.edge_rev,
                                 .found_rpm = heard->found_rpm,
                                 .found_sd_rpm = heard->found_sd_rpm});
  if (!options.report.empty()) {
    put_report(answer, options.report,
               page_of(answer.json, options, machine, shown_channel(*channels, events), teeth,
                       heard->window));
  }
  return answer;
}

/// Files first: a missing process is reported before a long recording is read.
Outcome run(const Options& options, Progress& progress) {
  if (auto refusal = unfit(options)) {
    return refused(*refusal);
  }
  const auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  std::optional<offline::Process> process;
  if (!options.process.empty()) {
    auto read = offline::read_process_all_faults(options.process);
    if (!read) {
      return std::unexpected(read.error());
    }
    process = std::move(*read);
  }
  // A process file knows its cutter; --teeth is excluded beside it.
  const std::size_t teeth = process ? process->tool.teeth : *options.teeth;
  return detect(options, *machine, teeth, process, progress);
}

}  // namespace
}  // namespace chatter_detect

void add_verb_chatter_detect(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_detect::Options>();
  verb.reads("signal", options->signal,
             "CSV, WAV or UFF (time responses), 1 kHz … 1 MHz. CSV: a column of times (t_s, "
             "Time (s) …), if recorded the speed (speed_rpm, n (1/min) …), all others of numbers "
             "are channels, or the one named value")
      ->required();
  add_machine_option(verb, options->machine);
  CLI::Option* const teeth =
      verb.add_option("--teeth", options->teeth, "Number of teeth, 1 in turning");
  add_log_options(verb, options->format, "t_s,value,speed_rpm");
  verb.reads(
          "--process", options->process,
          "Process file (TOML). With --depth-mm the better speed comes from `chatter plan`; "
          "without it, it is the deepest override step. With no process file no step is advised: "
          "the chatter frequency alone names the lobes' speeds")
      ->excludes(teeth);
  verb.also_reads([options] { return chatter::offline::response_files(options->process); });
  verb.add_option("--rate-hz", options->rate_hz,
                  "Samples per second, for a CSV without a column of times, or with uneven ones; "
                  "its header may be missing too")
      ->excludes(verb.get_option("--sample-hz"));
  verb.add_option("--channel", options->channel,
                  "Judge this channel alone, by its number from 1 or its name; default: all");
  CLI::Option* const speed =
      verb.add_option("--speed-rpm", options->speed_rpm,
                      "Spindle speed in rev/min, for a signal without a column of it");
  verb.add_option("--speed-from-name", options->speed_pattern,
                  "The same, from the file's name: {rpm} is the number, * anything, as in "
                  "S{rpm}_f*.csv")
      ->excludes(speed);
  verb.add_option("--programmed-rpm", options->programmed_rpm,
                  "Spindle speed at 100 % override; default: the signal's");
  verb.add_option("--edge-revolutions", options->edge_rev,
                  "Vibration that ends within so many revolutions of the tool's entry or exit is "
                  "named, not counted as chatter; default: 10");
  verb.add_option("--depth-mm", options->depth_mm,
                  "Axial depth of cut, for --process; without it the deepest step is advised");
  verb.reports(options->report);
  session.on(verb,
             [options](Progress& progress) { return chatter_detect::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
