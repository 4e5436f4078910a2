// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/chatter/chatter_events.hpp>
#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Several sensors at one cut: each channel is judged, the cut has one verdict.
namespace steadyrest::apps::cli {

/// What people call a channel: its name, else its number.
[[nodiscard]] std::string channel_label(const chatter::offline::RecordedSignal& signal);

/// The channel asked for by number or name, or all. A name may lack its unit and its capitals.
/// Refused: a channel that the file does not have, a name that several have.
[[nodiscard]] kernel::outcome::Result<chatter::offline::RecordedChannels> chosen_channels(
    chatter::offline::RecordedChannels all, const std::string& channel, const std::string& file);

/// The speeds of the command line.
struct GivenSpeeds {
  std::optional<double> speed_rpm;
  std::optional<double> programmed_rpm;
  const char* option = "--speed-rpm";  ///< where speed_rpm comes from
};

/// A recording from the machine may contain its speed as a column. Otherwise the operator's number
/// applies to all of it. Refused: both or neither, and speeds beyond the spindle's.
[[nodiscard]] std::optional<kernel::outcome::Refusal> set_speed(
    const GivenSpeeds& given, const kernel::machine::Machine& machine, const std::string& file,
    chatter::offline::RecordedSignal& signal);

struct Heard {
  std::vector<ChatterEvent>
      events;  ///< as_one(); those at an edge of the cut are named, not counted
  std::vector<chatter::offline::Engagement> cuts;  ///< by the first channel that shows them
  std::size_t window = 0;                          ///< samples of a spectrum
  std::vector<std::string> notes;
  std::vector<std::string> sensor;  ///< what these recordings cannot show, before the verdict
  double found_rpm = 0.0;           ///< by the orders of the first channel that shows them; 0: none
  double found_sd_rpm = 0.0;
};

/// Listens to each channel from the first sample to the last. Stretches within `edge_rev`
/// revolutions of the tool's entry or exit are marked. Channels without a signal are taken out of
/// the list, with a note. Refused: all are, or a recording is shorter than a spectrum.
[[nodiscard]] kernel::outcome::Result<Heard> hear(chatter::offline::RecordedChannels& channels,
                                                  std::size_t teeth, double edge_rev,
                                                  const std::string& file, Progress& progress);

/// Stretches that several channels hear at once count once: from the first that hears it, with its
/// frequency, to the last. In order of their start.
[[nodiscard]] std::vector<ChatterEvent> as_one(std::vector<ChatterEvent> events);

}  // namespace steadyrest::apps::cli
