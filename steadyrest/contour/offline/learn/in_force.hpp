// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/contour/offline/learn/planned_motion.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// What a sample of a record is good for.
enum class Use : std::uint8_t {
  learns,
  no_cut,      ///< rapids and all else that leaves no surface
  off_path,    ///< the commands are not on the program's path: another program, a restart, jogging
  paused,      ///< standing still inside a cut
  overridden,  ///< another feed than planned
  too_large,   ///< off by more than any model should be
};
/// The reason that a stretch is left out, for people.
[[nodiscard]] std::string_view reason_of(Use use) noexcept;

struct JudgeConfig {
  double near_mm = 0.02;     ///< of a command to the program's path
  double feed_share = 0.05;  ///< by which the feed may differ from the plan
  double window_s = 0.2;     ///< over which it is compared
  double settle_s = 0.1;     ///< after a disturbance until the servos have forgotten it
};

/// The place of each sample's command on the path, and its use.
struct Judged {
  std::vector<Use> use;
  std::vector<double> position_mm;  ///< the last known one where the command is off the path
  std::vector<std::size_t> segment;
};

/// Holds a record against the program that is said to have been cut.
///
/// Law. PathFollower gives each command's place. Within a cut, over each window of `window_s`, the
/// time that passed in the record is compared with the planned time between the two places; where
/// they differ by more than `feed_share` and 1.5 samples, the whole window is left out: as a pause
/// if the command stood still in it, else as an override. What follows within `settle_s` is left
/// out too. A gap in the record is a pause.
[[nodiscard]] Judged judge(const PartRecord& record, kernel::signal::PathView path,
                           const PlannedMotion& plan, const JudgeConfig& config);

}  // namespace steadyrest::contour::offline
