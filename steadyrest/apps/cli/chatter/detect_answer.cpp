// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/chatter/detect_answer.hpp>
#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/chatter/online/line_evidence.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {

namespace offline = chatter::offline;
namespace online = chatter::online;
using kernel::units::rpm_from_rev_s;

namespace {

const char* adviser_name(DetectAdviser by) {
  return by == DetectAdviser::planner ? "planner"
         : by == DetectAdviser::step  ? "deepest step"
                                      : "chatter frequency";
}

/// The request is neutral when nothing is better; a speed of 0 says so.
std::string better_words(const DetectEvent& event) {
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

/// The channels by their numbers, the names for all of them.
const offline::RecordedSignal* channel_of(const offline::RecordedChannels& channels,
                                          std::size_t number) {
  const auto found = std::ranges::find(channels, number, &offline::RecordedSignal::channel);
  return found == channels.end() ? nullptr : &*found;
}

Json name_or_null(const std::string& name) {
  return name.empty() ? Json(nullptr) : Json(name);
}

Json names_of(const offline::RecordedChannels& channels, const std::vector<std::size_t>& numbers) {
  Json out = Json::array();
  for (const std::size_t number : numbers) {
    const auto* const channel = channel_of(channels, number);
    out.push_back(name_or_null(channel == nullptr ? std::string() : channel->name));
  }
  return out;
}

std::string labels_of(const offline::RecordedChannels& channels,
                      const std::vector<std::size_t>& numbers) {
  std::vector<std::string> out;
  for (const std::size_t number : numbers) {
    const auto* const channel = channel_of(channels, number);
    out.push_back(channel == nullptr ? fmt::format("{}", number) : channel_label(*channel));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

/// "12.31 × spindle, 4.1 Hz from 12": why it is not forced vibration.
std::string evidence_words(const DetectEvent& event) {
  const ChatterEvidence& first = event.evidence.front();
  const double order = event.frequency_hz / std::max(event.spindle_rev_s, 1e-9);
  const std::string by = event.flip
                             ? "grew while the tooth orders held steady"
                             : fmt::format("{:.1f} Hz from {}{}", std::abs(first.from_order_hz),
                                           first.order, first.folded ? ", folded" : "");
  return fmt::format("{:.2f} × spindle, {}", order, by);
}

Json evidence_json(const ChatterEvidence& of) {
  return {{"channel", of.channel},
          {"start_s", of.start_s},
          {"frequency_hz", of.frequency_hz},
          {"nearest_order", of.order},
          {"order_folded", of.folded},
          {"from_order_hz", of.from_order_hz},
          {"from_order_sd_hz", of.from_order_sd_hz},
          {"confidence", of.confidence}};
}

/// The nearest mode of the process file; null without a process file.
Json mode_json(const DetectEvent& event, const std::vector<double>& modes_hz) {
  if (modes_hz.empty()) {
    return nullptr;
  }
  const double nearest = online::nearest_mode_hz(modes_hz, event.frequency_hz);
  return {{"frequency_hz", nearest}, {"off_hz", event.frequency_hz - nearest}};
}

Json event_json(const offline::RecordedChannels& channels, const DetectEvent& event,
                const std::vector<double>& modes_hz) {
  const auto& advice = event.advice;
  const bool better = advice.speed_rev_s > 0.0;
  const double percent = 100.0 * advice.request.ratio;
  Json evidence = Json::array();
  for (const ChatterEvidence& of : event.evidence) {
    evidence.push_back(evidence_json(of));
  }
  return {
      {"start_s", event.start_s},
      {"end_s", event.end_s},
      {"frequency_hz", event.frequency_hz},
      {"type", event.flip ? "flip" : "hopf"},
      {"channels", event.channels},
      {"channel_names", names_of(channels, event.channels)},
      {"speed_rpm", rpm_from_rev_s(event.speed_rev_s)},
      {"order", event.frequency_hz / std::max(event.spindle_rev_s, 1e-9)},
      {"confidence", std::ranges::max(event.evidence, {}, &ChatterEvidence::confidence).confidence},
      {"evidence", std::move(evidence)},
      {"nearest_mode", mode_json(event, modes_hz)},
      {"advised_speed_rpm", better ? Json(rpm_from_rev_s(advice.speed_rev_s)) : Json(nullptr)},
      {"advised_override_percent", better ? Json(percent) : Json(nullptr)},
      {"lobe_speeds_rpm", event.lobes_rpm},
      {"decision", event.plan ? Json(offline::name(event.plan->decision)) : Json(nullptr)}};
}

const char* place_name(offline::CutPlace at) {
  return at == offline::CutPlace::entry ? "entry" : at == offline::CutPlace::exit ? "exit" : "air";
}

std::string place_words(offline::CutPlace at, double edge_rev) {
  return at == offline::CutPlace::air
             ? "begins while the tool is out of the cut"
             : fmt::format("within {:g} revolutions of the tool's {}", edge_rev, place_name(at));
}

void add_engagement(const DetectSetting& setting, Answer& answer) {
  answer.json["cuts"] = Json::array();
  for (const offline::Engagement& cut : setting.cuts) {
    answer.json["cuts"].push_back({{"start_s", cut.begin_s},
                                   {"end_s", cut.end_s},
                                   {"entry_seen", cut.entry},
                                   {"exit_seen", cut.exit}});
  }
  answer.json["edge_revolutions"] = setting.edge_rev;
  answer.json["at_edges"] = Json::array();
  for (const ChatterEvent& event : setting.at_edges) {
    answer.json["at_edges"].push_back({{"start_s", event.start_s},
                                       {"end_s", event.end_s},
                                       {"frequency_hz", event.frequency_hz},
                                       {"at", place_name(event.at)}});
    answer.text +=
        fmt::format("{:.3f} to {:.3f} s: {:.1f} Hz {}; not counted as chatter\n", event.start_s,
                    event.end_s, event.frequency_hz, place_words(event.at, setting.edge_rev));
  }
}

void add_recording(const offline::RecordedChannels& channels, Json& json) {
  const offline::RecordedSignal& signal = channels.front();
  json["seconds"] = static_cast<double>(signal.value.size()) / signal.rate_hz;
  json["sample_rate_hz"] = signal.recorded_hz;
  json["judged_rate_hz"] = signal.rate_hz;
  for (const char* key : {"channels", "channel_names", "channel_units"}) {
    json[key] = Json::array();
  }
  for (const offline::RecordedSignal& channel : channels) {
    json["channels"].push_back(channel.channel);
    json["channel_names"].push_back(name_or_null(channel.name));
    json["channel_units"].push_back(name_or_null(channel.unit));
  }
}

}  // namespace

Answer detect_answer(const offline::RecordedChannels& channels,
                     const std::vector<DetectEvent>& events, const DetectSetting& setting) {
  const DetectAdviser by = setting.by;
  const offline::RecordedSignal& signal = channels.front();
  Answer answer;
  answer.json["advice_by"] = adviser_name(by);
  answer.json["events"] = Json::array();
  Table table({"from", "to", "frequency", "type", "evidence", "confidence", "at",
               by == DetectAdviser::frequency
                   ? "lobes, by the chatter frequency"
                   : fmt::format("better speed, by the {}", adviser_name(by))});
  // A file with one `value` has nothing to tell apart.
  const std::string& only = channels.front().name;
  const bool named = channels.size() > 1 || (!only.empty() && only != "value");
  for (const DetectEvent& event : events) {
    answer.json["events"].push_back(event_json(channels, event, setting.modes_hz));
    const std::string where =
        named ? ", channel " + labels_of(channels, event.channels) : std::string();
    table.row({fmt::format("{:.3f} s", event.start_s), fmt::format("{:.3f} s", event.end_s),
               fmt::format("{:.1f} Hz", event.frequency_hz), event.flip ? "flip" : "hopf",
               evidence_words(event),
               fmt::format("{:.0f} %", 100.0 * event.evidence.front().confidence),
               fmt::format("{:.0f} rpm{}", rpm_from_rev_s(event.speed_rev_s), where),
               better_words(event)});
  }
  const double length_s = static_cast<double>(signal.value.size()) / signal.rate_hz;
  add_recording(channels, answer.json);
  answer.json["spindle_rpm"] = setting.found_rpm > 0.0 ? Json(setting.found_rpm) : Json(nullptr);
  answer.json["spindle_sd_rpm"] =
      setting.found_rpm > 0.0 ? Json(setting.found_sd_rpm) : Json(nullptr);
  answer.json["sensor"] = setting.sensor;
  answer.json["notes"] = setting.notes;
  for (const std::string& words : setting.sensor) {
    answer.text += words + "\n";
  }
  add_engagement(setting, answer);
  answer.text += events.empty()
                     ? fmt::format("no chatter in {:.3f} s{}\n", length_s,
                                   channels.size() > 1
                                       ? fmt::format(", on none of {} channels", channels.size())
                                       : std::string())
                     : table.text();
  if (by == DetectAdviser::frequency && !events.empty()) {
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

}  // namespace steadyrest::apps::cli
