// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/chatter/detect_channels.hpp>
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
      fmt::format("--channel {} is {} of {}: {}", channel,
                  found.empty() ? "none" : fmt::format("the name of {}", found.size()), all.size(),
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
  for (const RecordedSignal& signal : channels) {
    for (const std::string& note : signal.notes) {
      if (std::ranges::find(out.notes, note) == out.notes.end()) {
        out.notes.push_back(note);
      }
    }
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
