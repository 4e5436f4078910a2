// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
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
    notes.push_back(fmt::format("channel {} is not judged: {}", signal.channel, dead->what));
    if (!first) {
      first = std::move(dead);
    }
  }
  channels = std::move(living);
  return channels.empty() ? std::move(first) : std::nullopt;
}

}  // namespace

Result<RecordedChannels> chosen_channels(RecordedChannels all, std::optional<std::size_t> channel,
                                         const std::string& file) {
  if (!channel) {
    return all;
  }
  if (*channel < 1 || *channel > all.size()) {
    return kernel::outcome::refuse(
        file,
        fmt::format("has {} {}; --channel {} is none of them", all.size(),
                    all.size() == 1 ? "channel" : "channels", *channel),
        "count channels from 1: 1 is left, 2 right");
  }
  RecordedChannels out;
  out.push_back(std::move(all[*channel - 1]));
  return out;
}

// Both at once would leave open which one wins.
std::optional<Refusal> set_speed(const GivenSpeeds& given, const kernel::machine::Machine& machine,
                                 const std::string& file, RecordedSignal& signal) {
  std::vector<double>& speed = signal.speed_rev_s;
  if (!speed.empty() && given.speed_rpm) {
    return bad_input(file, "has a speed_rpm column, and --speed-rpm is given too",
                     "leave out --speed-rpm");
  }
  if (speed.empty() && !given.speed_rpm) {
    return bad_input(file, "has no spindle speed",
                     "give --speed-rpm N, or a CSV with a speed_rpm column");
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
      return above("--speed-rpm", *given.speed_rpm, {});
    }
    speed.assign(signal.value.size(), kernel::units::rev_s_from_rpm(*given.speed_rpm));
  }
  if (const double most = rpm_from_rev_s(std::ranges::max(speed)); most > most_rpm * kOvershoot) {
    return above("speed_rpm", most, file);
  }
  // All frequencies are judged by their order (frequency over speed), and at speed 0 there is none.
  if (std::ranges::none_of(speed, [](double s) { return s > 0.0; })) {
    return bad_input(file, "speed_rpm is 0 throughout",
                     "give a recording with the spindle running");
  }
  return std::nullopt;
}

Result<Heard> hear(RecordedChannels& channels, std::size_t teeth, const std::string& file,
                   Progress& progress) {
  Heard out;
  // The rate is the same in all channels.
  const auto made =
      chatter::online::Detector::make({.sample_rate_hz = channels.front().rate_hz, .teeth = teeth});
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
  if (auto refusal = drop_dead(channels, file, out.notes)) {
    return std::unexpected(std::move(*refusal));
  }
  if (channels.front().recorded_hz != channels.front().rate_hz) {
    out.notes.push_back(fmt::format("{:.6g} samples a second were reduced to {:.6g}",
                                    channels.front().recorded_hz, channels.front().rate_hz));
  }
  for (const RecordedSignal& signal : channels) {
    auto detector = *made;
    std::ranges::move(chatter_events(signal, detector, progress), std::back_inserter(out.events));
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
    for (const std::size_t channel : event.channels) {
      if (std::ranges::find(known->channels, channel) == known->channels.end()) {
        known->channels.push_back(channel);
      }
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
