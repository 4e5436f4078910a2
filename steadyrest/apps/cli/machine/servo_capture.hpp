// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/apps/cli/machine/servo_log.hpp>

namespace steadyrest::apps::cli {

/// A capture of SINUMERIK Edge: HFData by the addresses in its header; CYCLE counts CycleTimeMs.
[[nodiscard]] kernel::outcome::Result<RecordedServos> servo_capture(const std::string& file,
                                                                    std::string_view text,
                                                                    const ServoSource& source);

/// A trace of SINUMERIK (Solution Line XML): each signal's values at its changes, held between.
/// Needs of each axis the position setpoint, nckServoDataCmdPos…, and the actual position,
/// nckServoDataActPos… or measPos…, or the following error, nckServoDataFlwErr….
[[nodiscard]] kernel::outcome::Result<RecordedServos> servo_trace(const std::string& file,
                                                                  std::string_view text,
                                                                  const ServoSource& source);

/// The recorded axis of each axis to read: as --columns X=1 says, or by its name, or by its number.
struct RecordedAxis {
  int number = 0;
  std::string name;  ///< empty: the file does not say
};
[[nodiscard]] kernel::outcome::Result<std::vector<int>> numbers_of(
    const std::string& file, const ServoSource& source, const std::vector<RecordedAxis>& recorded);

}  // namespace steadyrest::apps::cli
