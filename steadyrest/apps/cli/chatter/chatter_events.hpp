// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>

namespace steadyrest::apps::cli {

/// One stretch of chatter in a recorded signal.
struct ChatterEvent {
  double start_s = 0.0;
  double end_s = 0.0;
  double frequency_hz = 0.0;          ///< median over the stretch
  double speed_rev_s = 0.0;           ///< mean over the stretch
  bool flip = false;                  ///< majority of the spectra
  std::vector<std::size_t> channels;  ///< that hear it, the first to do so in front
};

/// What the detector hears from the signal's first sample to its last; the signal has a speed.
[[nodiscard]] std::vector<ChatterEvent> chatter_events(
    const chatter::offline::RecordedSignal& signal, chatter::online::Detector& detector,
    Progress& progress);

/// Speeds at which k whole waves of the chatter fit between two teeth, falling; within the
/// override's and the spindle's reach.
[[nodiscard]] std::vector<double> lobes_rpm(const chatter::online::SpeedTable::Config& reach,
                                            double programmed_rev_s, double frequency_hz);

}  // namespace steadyrest::apps::cli
