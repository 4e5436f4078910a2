// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/chatter/chatter_events.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>

namespace steadyrest::apps::cli {

/// A stretch of chatter with the advice for it.
struct DetectEvent : ChatterEvent {
  chatter::online::SpeedTable::Advice advice;
  std::vector<double> lobes_rpm;  ///< by the frequency alone, where no process is known
  std::optional<chatter::offline::Plan> plan;  ///< where process and depth are known
};

/// Where the advice comes from, best first: a plan for this very cut, the border alone, the
/// frequency alone.
enum class DetectAdviser : std::uint8_t { planner, step, frequency };

/// What is known of the recording and its cut beside the stretches.
struct DetectSetting {
  DetectAdviser by = DetectAdviser::frequency;
  std::vector<double> modes_hz;     ///< of the process file
  std::vector<std::string> sensor;  ///< Heard::sensor
  std::vector<std::string> notes;
  std::vector<chatter::offline::Engagement> cuts;  ///< Heard::cuts
  std::vector<ChatterEvent> at_edges;              ///< stretches at an edge of a cut, or out of it
  double edge_rev = 0.0;                           ///< so near to it
  double found_rpm = 0.0;                          ///< Heard::found_rpm
  double found_sd_rpm = 0.0;
};

/// What `chatter detect` says: what the sensor cannot show; of each stretch where, how high, in
/// which channels, by what evidence, and the better speed; of the recording its length, rates and
/// channels.
[[nodiscard]] Answer detect_answer(const chatter::offline::RecordedChannels& channels,
                                   const std::vector<DetectEvent>& events,
                                   const DetectSetting& setting);

}  // namespace steadyrest::apps::cli
