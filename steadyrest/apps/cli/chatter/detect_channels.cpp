// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
#include <steadyrest/chatter/offline/signal/order_check.hpp>
#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {

using chatter::offline::RecordedChannels;
using chatter::offline::RecordedSignal;
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::units::rpm_from_rev_s;

namespace {

std::string list_of(const RecordedChannels& all) {
  constexpr std::size_t kMostListed = 20;
  std::vector<std::string> out;
  for (const RecordedSignal& signal : all) {
    if (out.size() == kMostListed) {
      out.emplace_back("…");
      break;
    }
    const std::string name =
        chatter::offline::shown_name(signal.written.empty() ? signal.name : signal.written);
    out.push_back(name.empty() ? fmt::format("{}", signal.channel)
                               : fmt::format("{} {}", signal.channel, name));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The channels of a name, as the file writes it, else without its unit; capitals or not.
std::vector<std::size_t> named(const RecordedChannels& all, const std::string& channel) {
  const auto same = [&channel](const std::string& name) {
    return !name.empty() && chatter::offline::same_name(name, channel);
  };
  std::vector<std::size_t> whole;
  std::vector<std::size_t> part;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (same(all[i].written)) {
      whole.push_back(i);
    } else if (same(all[i].name) || same(chatter::offline::without_unit(all[i].name))) {
      part.push_back(i);
    }
  }
  return whole.empty() ? part : whole;
}

/// Takes out what has no signal.
std::optional<Refusal> drop_dead(RecordedChannels& channels, const std::string& file,
                                 std::vector<std::string>& notes) {
  RecordedChannels living;
  std::optional<Refusal> first;
  for (RecordedSignal& signal : channels) {
    auto dead = chatter::offline::no_signal(signal, file);
    if (!dead) {
      living.push_back(std::move(signal));
      continue;
    }
    notes.push_back(fmt::format("channel {} is not judged: {}", channel_label(signal), dead->what));
    if (!first) {
      first = std::move(dead);
    }
  }
  channels = std::move(living);
  return channels.empty() ? std::move(first) : std::nullopt;
}

}  // namespace

std::string channel_label(const RecordedSignal& signal) {
  return signal.name.empty() ? fmt::format("{}", signal.channel)
                             : chatter::offline::shown_name(signal.name);
}

// A column may be called 2: names come first.
Result<RecordedChannels> chosen_channels(RecordedChannels all, const std::string& channel,
                                         const std::string& file) {
  if (channel.empty()) {
    return all;
  }
  const auto chosen = [&all](std::size_t at) {
    RecordedChannels out;
    out.push_back(std::move(all[at]));
    return out;
  };
  std::vector<std::size_t> found = named(all, channel);
  if (found.size() == 1) {
    return chosen(found.front());
  }
  for (const RecordedSignal& signal : all) {
    if (found.empty() && fmt::format("{}", signal.channel) == channel) {
      return chosen(signal.channel - 1);
    }
  }
  return kernel::outcome::refuse(
      file,
      fmt::format("--channel {} matches {} of the {} channels: {}", channel,
                  found.empty() ? "none" : fmt::format("{}", found.size()), all.size(),
                  list_of(all)),
      "give one of these numbers or names, with or without its unit");
}

// Both at once would leave open which one wins.
std::optional<Refusal> set_speed(const GivenSpeeds& given, const kernel::machine::Machine& machine,
                                 const std::string& file, RecordedSignal& signal) {
  std::vector<double>& speed = signal.speed_rev_s;
  if (!speed.empty() && given.speed_rpm) {
    return bad_input(file, fmt::format("has a speed_rpm column, and {} is given too", given.option),
                     fmt::format("leave out {}", given.option));
  }
  if (speed.empty() && !given.speed_rpm) {
    return bad_input(
        file, "has no spindle speed",
        "give --speed-rpm N or --speed-from-name PATTERN, or a CSV with a speed_rpm column");
  }
  // The first margin lets a speed pass that is the spindle's limit to the last digit printed, the
  // second a spindle that overshoots.
  const double most_rpm = rpm_from_rev_s(machine.spindle.max_rev_s);
  constexpr double kRounding = 1.0 + 1e-9;
  constexpr double kOvershoot = 1.2;
  const auto above = [most_rpm](const char* what, double rpm, const std::string& from) {
    return bad_input(from,
                     fmt::format("{} {:.6g} is above the spindle's {:.6g}", what, rpm, most_rpm),
                     "give the speed in rev/min, or the right machine file");
  };
  if (given.programmed_rpm && *given.programmed_rpm > most_rpm * kRounding) {
    return above("--programmed-rpm", *given.programmed_rpm, {});
  }
  if (given.speed_rpm) {
    if (*given.speed_rpm > most_rpm * kRounding) {
      return above(given.option, *given.speed_rpm, {});
    }
    speed.assign(signal.value.size(), kernel::units::rev_s_from_rpm(*given.speed_rpm));
  }
  if (const double most = rpm_from_rev_s(chatter::offline::finite_range(speed).most);
      most > most_rpm * kOvershoot) {
    return above("speed_rpm", most, file);
  }
  // All frequencies are judged by their order (frequency over speed), and at speed 0 there is none.
  if (std::ranges::none_of(speed, [](double s) { return s > 0.0; })) {
    return bad_input(file, "speed_rpm is 0 throughout",
                     "give a recording with the spindle running");
  }
  return std::nullopt;
}

namespace {

/// How far a recorder's clock or a spindle may be off the stated speed, relative.
constexpr double kToldSpeed = 0.003;
constexpr double kHeardShare = 0.45;  ///< of the rate
constexpr double kNarrowHz = 2500.0;
constexpr double kEdge_s = 0.15;     // a mode rings so long, however fast the spindle is
constexpr double kOffToSay = 0.001;  ///< of the speed

void say_band(const RecordedSignal& signal, Heard& out) {
  const double most_hz = kHeardShare * signal.rate_hz;
  if (most_hz < kNarrowHz) {
    out.sensor.push_back(fmt::format(
        "at {:.0f} samples per second chatter above {:.0f} Hz cannot be identified; higher orders "
        "are assumed to fold back, and lines near their folds count as forced",
        signal.rate_hz, most_hz));
  }
}

void scale_speed(RecordedChannels& channels, std::size_t begin, std::size_t end, double ratio) {
  for (RecordedSignal& signal : channels) {
    for (std::size_t i = begin; i < end; ++i) {
      signal.speed_rev_s[i] *= ratio;
    }
  }
}

/// The same part by part: several tools or speeds in one file. False: all parts are as stated.
bool check_parts(RecordedChannels& channels, std::size_t teeth, Heard& out) {
  const RecordedSignal& first = channels.front();
  const auto others =
      chatter::offline::other_cuts(first.value, first.speed_rev_s, first.rate_hz, teeth);
  const bool whole =
      others.size() == 1 && others.front().begin == 0 && others.front().end == first.value.size();
  if (others.empty() || whole) {
    return false;
  }
  for (const chatter::offline::OtherCut& other : others) {
    const auto at_s = [&first](std::size_t i) {
      return first.start_s + static_cast<double>(i) / first.rate_hz;
    };
    std::string what = fmt::format("from {:.1f} to {:.1f} s", at_s(other.begin), at_s(other.end));
    if (other.speed_rev_s > 0.0) {
      what += fmt::format(" the lines fit a spindle at {:.0f} rpm, not {:.0f} rpm",
                          rpm_from_rev_s(other.speed_rev_s), rpm_from_rev_s(other.told_rev_s));
      scale_speed(channels, other.begin, other.end, other.speed_rev_s / other.told_rev_s);
    }
    if (other.other_teeth > 0) {
      what += fmt::format("{} the strong orders are multiples of {}, not of {}",
                          other.speed_rev_s > 0.0 ? ", and" : "", other.other_teeth, teeth);
    }
    out.sensor.push_back(what + ": another tool or speed than stated; judged by its lines");
  }
  return true;
}

/// Checks the stated speed and number of teeth against the lines of the recording. If the lines
/// clearly fit another speed, that speed is used.
bool check_orders_of(RecordedChannels& channels, std::size_t teeth, Heard& out) {
  const RecordedSignal& first = channels.front();
  const double told_rev_s = chatter::offline::constant_speed(first.speed_rev_s);
  if (!(told_rev_s > 0.0)) {
    return false;
  }
  const auto found = chatter::offline::check_orders(first.value, first.rate_hz, told_rev_s, teeth);
  if (found.other_speed) {
    out.sensor.push_back(fmt::format(
        "the spectral lines fit a spindle at {:.0f} rpm ({:.0f} % of them), not {:.0f} rpm "
        "({:.0f} %): the stated speed or sampling rate is wrong; judged at the speed of the lines",
        rpm_from_rev_s(found.speed_rev_s), 100.0 * found.found_share, rpm_from_rev_s(told_rev_s),
        100.0 * std::max(0.0, found.told_share)));
    scale_speed(channels, 0, first.value.size(), found.speed_rev_s / told_rev_s);
  }
  if (found.other_teeth > 0) {
    out.sensor.push_back(
        fmt::format("the strong orders are multiples of {}, which does not fit {} teeth",
                    found.other_teeth, teeth));
  }
  return found.known;
}

/// Reports what the first channel shows of the spindle speed.
void say_speed(const HeardChannel& heard, bool orders_known, Heard& out) {
  if (heard.found_rev_s > 0.0) {
    const double off = heard.found_rev_s / heard.told_rev_s - 1.0;
    if (std::abs(off) > kOffToSay) {
      out.sensor.push_back(fmt::format(
          "the orders show the spindle at {:.1f} rpm, {:.2f} % {} the stated speed",
          rpm_from_rev_s(heard.found_rev_s), 100.0 * std::abs(off), off < 0.0 ? "below" : "above"));
    }
  } else if (!orders_known && heard.events.empty()) {
    out.sensor.emplace_back(
        "no spindle orders rise above the noise: the tool may be cutting air, the stated speed may "
        "be wrong, or other vibration may hide them");
  } else {
    out.sensor.push_back(fmt::format(
        "the orders do not show the spindle speed: it is taken to be within {:.1f} % of the stated "
        "one, and lines that close to an order count as forced",
        100.0 * kToldSpeed));
  }
}

/// Where each of the channel's stretches is; its cuts.
std::vector<chatter::offline::Engagement> place(HeardChannel& heard, double edge_rev) {
  auto cuts = chatter::offline::engagements(heard.levels);
  for (ChatterEvent& event : heard.events) {
    const double within_s =
        edge_rev > 0.0 ? std::max(edge_rev / event.spindle_rev_s, kEdge_s) : 0.0;
    event.at = chatter::offline::place_of(
        cuts, {.start_s = event.start_s, .end_s = event.end_s, .energy = event.line_energy},
        within_s);
  }
  return cuts;
}

/// The notes of all channels, once each.
void gather_notes(const RecordedChannels& channels, Heard& out) {
  for (const RecordedSignal& signal : channels) {
    for (const std::string& note : signal.notes) {
      if (std::ranges::find(out.notes, note) == out.notes.end()) {
        out.notes.push_back(note);
      }
    }
  }
}

}  // namespace

Result<Heard> hear(RecordedChannels& channels, std::size_t teeth, double edge_rev,
                   const std::string& file, Progress& progress) {
  Heard out;
  // The rate is the same in all channels.
  const double rate_hz = channels.front().rate_hz;
  const auto made =
      chatter::online::Detector::make({.sample_rate_hz = rate_hz,
                                       .teeth = teeth,
                                       .speed_sd = kToldSpeed,
                                       .folds = chatter::online::Detector::folds_at(rate_hz)});
  if (!made) {
    return std::unexpected(made.error());
  }
  out.window = made->window();
  // The detector answers after one full window. Shorter than that it would say "no chatter" about a
  // signal that it never judged.
  if (channels.front().value.size() < out.window) {
    return kernel::outcome::refuse(file,
                                   fmt::format("has {} samples; one spectrum needs {}",
                                               channels.front().value.size(), out.window),
                                   "give a longer recording: a few tenths of a second");
  }
  gather_notes(channels, out);
  if (auto refusal = drop_dead(channels, file, out.notes)) {
    return std::unexpected(std::move(*refusal));
  }
  if (channels.front().recorded_hz != channels.front().rate_hz) {
    out.notes.push_back(fmt::format("{:.6g} samples a second were reduced to {:.6g}",
                                    channels.front().recorded_hz, channels.front().rate_hz));
  }
  say_band(channels.front(), out);
  const bool parts = check_parts(channels, teeth, out);
  const bool orders_known = !parts && check_orders_of(channels, teeth, out);
  for (RecordedSignal& signal : channels) {
    auto detector = *made;
    HeardChannel heard = hear_channel(signal, detector, progress);
    auto cuts = place(heard, edge_rev);
    if (heard.clips) {
      out.sensor.push_back(fmt::format(
          "channel {} clips: clipping adds harmonics at every order of the spindle, so every order "
          "counts as forced",
          channel_label(signal)));
    }
    if (!parts && out.found_rpm == 0.0 && heard.found_rev_s > 0.0) {
      out.found_rpm = rpm_from_rev_s(heard.found_rev_s);
      out.found_sd_rpm = rpm_from_rev_s(heard.found_sd_rev_s);
    }
    if (!parts && &signal == &channels.front()) {
      say_speed(heard, orders_known, out);
    }
    if (out.cuts.empty()) {
      out.cuts = std::move(cuts);
    }
    std::ranges::move(heard.events, std::back_inserter(out.events));
  }
  out.events = as_one(std::move(out.events));
  return out;
}

std::vector<ChatterEvent> as_one(std::vector<ChatterEvent> events) {
  constexpr double kSame = 0.02;  // of the frequency
  std::ranges::stable_sort(events, {}, &ChatterEvent::start_s);
  std::vector<ChatterEvent> out;
  for (ChatterEvent& event : events) {
    const auto known = std::ranges::find_if(out, [&](const ChatterEvent& before) {
      return event.start_s <= before.end_s &&
             std::abs(event.frequency_hz - before.frequency_hz) <= kSame * before.frequency_hz;
    });
    if (known == out.end()) {
      out.push_back(std::move(event));
      continue;
    }
    known->end_s = std::max(known->end_s, event.end_s);
    known->at = event.at == chatter::offline::CutPlace::cut ? event.at : known->at;
    for (std::size_t i = 0; i < event.channels.size(); ++i) {
      if (std::ranges::find(known->channels, event.channels[i]) == known->channels.end()) {
        known->channels.push_back(event.channels[i]);
        known->evidence.push_back(event.evidence[i]);
      }
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
