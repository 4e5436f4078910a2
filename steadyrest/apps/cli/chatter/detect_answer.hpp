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

/// What `chatter detect` says: of each stretch where, how high, in which channels, and the better
/// speed; of the recording its length, rates and channels.
[[nodiscard]] Answer detect_answer(const chatter::offline::RecordedChannels& channels,
                                   const std::vector<DetectEvent>& events, DetectAdviser by,
                                   const std::vector<std::string>& notes);

}  // namespace steadyrest::apps::cli
