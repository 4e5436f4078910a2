// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_detect.hpp>
#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/chatter/detect_page.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/plan/speed_table_of.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
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
using kernel::units::rpm_from_rev_s;

constexpr double kMostDepthMm = 10.0;  // of the table, where the cut's depth is not given

struct Options {
  std::string signal;
  std::string machine;
  std::string process;
  std::optional<std::size_t> teeth;
  std::optional<double> speed_rpm;
  std::optional<double> programmed_rpm;
  std::optional<double> depth_mm;
  std::optional<std::size_t> channel;
  std::string report;
  LogOptions format;
};

/// A stretch of chatter with the advice for it.
struct Event : ChatterEvent {
  online::SpeedTable::Advice advice;
  std::vector<double> lobes_rpm;      ///< by the frequency alone, where no process is known
  std::optional<offline::Plan> plan;  ///< where process and depth are known
};

/// Combinations and ranges that are wrong whatever the files contain.
std::optional<Refusal> unfit(const Options& options) {
  struct Given {
    const char* option;
    const std::optional<double>& value;
  };
  for (const Given& given :
       {Given{"--speed-rpm", options.speed_rpm}, Given{"--programmed-rpm", options.programmed_rpm},
        Given{"--depth-mm", options.depth_mm}}) {
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

/// Where the advice comes from, best first: a plan for this very cut, the border alone, the
/// frequency alone.
const char* adviser(const Options& options) {
  return options.process.empty() ? "chatter frequency"
         : options.depth_mm      ? "planner"
                                 : "deepest step";
}

/// The request is neutral when nothing is better; a speed of 0 says so.
std::string better_words(const Event& event) {
  const auto& advice = event.advice;
  if (advice.speed_rev_s > 0.0) {
    return fmt::format("{:.0f} rpm ({:.4g} %)", rpm_from_rev_s(advice.speed_rev_s),
                       100.0 * advice.request.ratio);
  }
  if (event.plan && event.plan->decision == offline::PlanDecision::law) {
    const auto& law = event.plan->chosen.modulation;
    return fmt::format("{} law of ±{:.4g} %, RVF {:.4g}", online::name(law.law), 100.0 * law.rva,
                       law.rvf);
  }
  if (event.plan && event.plan->decision == offline::PlanDecision::keep) {
    return "none: by the process file the cut is stable";
  }
  if (!event.lobes_rpm.empty()) {
    return fmt::format("unchecked: {:.0f} rpm", fmt::join(event.lobes_rpm, ", "));
  }
  return "none";
}

Answer answer_of(const offline::RecordedChannels& channels, const std::vector<Event>& events,
                 const Options& options, const std::vector<std::string>& notes) {
  const offline::RecordedSignal& signal = channels.front();
  Answer answer;
  answer.json["advice_by"] = adviser(options);
  answer.json["events"] = Json::array();
  Table table({"from", "to", "frequency", "type", "at",
               options.process.empty() ? "lobes, by the chatter frequency"
                                       : fmt::format("better speed, by the {}", adviser(options))});
  for (const Event& event : events) {
    const auto& advice = event.advice;
    const bool better = advice.speed_rev_s > 0.0;
    const double percent = 100.0 * advice.request.ratio;
    const char* type = event.flip ? "flip" : "hopf";
    const std::string where = channels.size() > 1
                                  ? fmt::format(", channel {}", fmt::join(event.channels, ", "))
                                  : std::string();
    answer.json["events"].push_back(
        {{"start_s", event.start_s},
         {"end_s", event.end_s},
         {"frequency_hz", event.frequency_hz},
         {"type", type},
         {"channels", event.channels},
         {"speed_rpm", rpm_from_rev_s(event.speed_rev_s)},
         {"advised_speed_rpm", better ? Json(rpm_from_rev_s(advice.speed_rev_s)) : Json(nullptr)},
         {"advised_override_percent", better ? Json(percent) : Json(nullptr)},
         {"lobe_speeds_rpm", event.lobes_rpm},
         {"decision", event.plan ? Json(offline::name(event.plan->decision)) : Json(nullptr)}});
    table.row({fmt::format("{:.3f} s", event.start_s), fmt::format("{:.3f} s", event.end_s),
               fmt::format("{:.1f} Hz", event.frequency_hz), type,
               fmt::format("{:.0f} rpm{}", rpm_from_rev_s(event.speed_rev_s), where),
               better_words(event)});
  }
  const double length_s = static_cast<double>(signal.value.size()) / signal.rate_hz;
  answer.json["seconds"] = length_s;
  answer.json["sample_rate_hz"] = signal.recorded_hz;
  answer.json["judged_rate_hz"] = signal.rate_hz;
  answer.json["channels"] = Json::array();
  for (const offline::RecordedSignal& channel : channels) {
    answer.json["channels"].push_back(channel.channel);
  }
  answer.json["notes"] = notes;
  answer.text = events.empty()
                    ? fmt::format("no chatter in {:.3f} s{}\n", length_s,
                                  channels.size() > 1
                                      ? fmt::format(", on none of {} channels", channels.size())
                                      : std::string())
                    : table.text();
  if (options.process.empty() && !events.empty()) {
    answer.json["notes"].push_back(
        "the speeds rest on the chatter frequency alone: 60·f/(teeth·k). They lie near the lobes, "
        "but whether the cut is stable there depends on the tool and the depth; --process FILE "
        "--depth-mm MM checks that and names a step");
  }
  for (const Json& note : answer.json["notes"]) {
    answer.text += note.get<std::string>() + "\n";
  }
  return answer;
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

/// Reads, listens to each channel, then asks for advice on each stretch.
Outcome detect(const Options& options, const Machine& machine, std::size_t teeth,
               const std::optional<offline::Process>& process, Progress& progress) {
  auto read = offline::read_signals(options.signal, format_of(options.format));
  auto channels = read ? chosen_channels(std::move(*read), options.channel, options.signal)
                       : std::unexpected(read.error());
  if (!channels) {
    return refused(channels.error());
  }
  for (offline::RecordedSignal& signal : *channels) {
    if (auto refusal = set_speed({options.speed_rpm, options.programmed_rpm}, machine,
                                 options.signal, signal)) {
      return refused(*refusal);
    }
  }
  auto heard = hear(*channels, teeth, options.signal, progress);
  if (!heard) {
    return refused(heard.error());
  }
  std::vector<Event> events;
  for (ChatterEvent& event : heard->events) {
    events.push_back({std::move(event), {}, {}, {}});
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
  Answer answer = answer_of(*channels, events, options, heard->notes);
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
             "CSV (t_s, value, optional speed_rpm) or WAV, 1 kHz … 1 MHz")
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
  verb.add_option("--channel", options->channel,
                  "Judge this channel of a WAV alone, from 1 (left); default: all");
  verb.add_option("--speed-rpm", options->speed_rpm,
                  "Spindle speed in rev/min, for a signal without a speed_rpm column");
  verb.add_option("--programmed-rpm", options->programmed_rpm,
                  "Spindle speed at 100 % override; default: the signal's");
  verb.add_option("--depth-mm", options->depth_mm,
                  "Axial depth of cut, for --process; without it the deepest step is advised");
  verb.reports(options->report);
  session.on(verb,
             [options](Progress& progress) { return chatter_detect::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
