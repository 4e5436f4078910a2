// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/chatter/offline/signal/engagement.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>

namespace steadyrest::apps::cli {

/// What one channel hears of a stretch.
struct ChatterEvidence {
  std::size_t channel = 0;
  double start_s = 0.0;
  double frequency_hz = 0.0;
  double from_order_hz = 0.0;     ///< of the nearest order that it could be, or the fold of one
  double from_order_sd_hz = 0.0;  ///< standard deviation of that
  std::size_t order = 0;
  bool folded = false;
  double confidence = 0.0;  ///< LineConfidence
};

/// One stretch of chatter in a recorded signal.
struct ChatterEvent {
  double start_s = 0.0;
  double end_s = 0.0;
  double frequency_hz = 0.0;   ///< median over the stretch
  double speed_rev_s = 0.0;    ///< as told, mean over the stretch
  double spindle_rev_s = 0.0;  ///< the same as the orders show it
  bool flip = false;           ///< majority of the spectra
  double line_energy = 0.0;    ///< unit², mean
  chatter::offline::CutPlace at = chatter::offline::CutPlace::cut;
  std::vector<std::size_t> channels;      ///< that hear it, the first to do so in front
  std::vector<ChatterEvidence> evidence;  ///< of each
};

/// A channel as it was heard.
struct HeardChannel {
  std::vector<ChatterEvent> events;
  double told_rev_s = 0.0;   ///< mean of the stated speed, while the orders show theirs
  double found_rev_s = 0.0;  ///< mean by the orders, while they show it; 0: they never do
  double found_sd_rev_s = 0.0;
  std::vector<chatter::offline::ForcedLevel> levels;  ///< of each spectrum
  bool clips = false;
};

/// What the detector hears from the signal's first sample to its last. The signal has a speed; it
/// becomes that of the orders where they show it.
[[nodiscard]] HeardChannel hear_channel(chatter::offline::RecordedSignal& signal,
                                        chatter::online::Detector& detector, Progress& progress);

/// Speeds at which k whole waves of the chatter fit between two teeth, falling; within the
/// override's and the spindle's reach.
[[nodiscard]] std::vector<double> lobes_rpm(const chatter::online::SpeedTable::Config& reach,
                                            double programmed_rev_s, double frequency_hz);

}  // namespace steadyrest::apps::cli
