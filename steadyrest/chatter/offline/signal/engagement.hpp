// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

/// When the tool enters and leaves the cut in a recording.
namespace steadyrest::chatter::offline {

/// Forced vibration in one moment, from Detector::Output.
struct ForcedLevel {
  double t_s = 0.0;
  double energy = 0.0;       ///< unit², mean over about a revolution
  double speed_rev_s = 0.0;  ///< > 0
};

struct Engagement {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool entry = false;   ///< the recording shows the tool entering; else it begins in the cut
  bool exit = false;    ///< … leaving; else it ends in the cut
  double energy = 0.0;  ///< median of the levels
};

/// Law. Levels are logarithms of the energy. Air has the 2nd percentile, the cut the 90th; where
/// they are less than 10 dB apart, neither entry nor exit is seen and the list is empty. The tool
/// is in the cut where the level is above the middle between the two, until it is 10 dB below the
/// median of its stretch for good (the filter forgets slowly); a stretch or a gap of fewer than 5
/// revolutions is none. Chatter hardly moves the level, for it is not forced.
[[nodiscard]] std::vector<Engagement> engagements(const std::vector<ForcedLevel>& levels);

enum class CutPlace : unsigned char { cut, entry, exit, air };

/// A stretch in which something vibrates.
struct Vibration {
  double start_s = 0.0;
  double end_s = 0.0;
  double energy = 0.0;  ///< of its lines, unit², mean
};

/// Where it is. `entry`, `exit`: it begins and ends within `within_s` of one, so that the change of
/// engagement itself can give it. `air`: it begins out of every cut and has less than a tenth of
/// the loudest cut's energy (a light cut beside a heavy one looks like air, its chatter does not).
/// Without cuts: `cut`.
[[nodiscard]] CutPlace place_of(const std::vector<Engagement>& cuts, const Vibration& vibration,
                                double within_s);

}  // namespace steadyrest::chatter::offline
