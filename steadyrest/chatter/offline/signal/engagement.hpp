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
  bool entry = false;  ///< the recording shows the tool entering; else it begins in the cut
  bool exit = false;   ///< … leaving; else it ends in the cut
};

/// Law. Levels are logarithms of the energy. Air has the 2nd percentile, the cut the 90th; where
/// they are less than 10 dB apart, neither entry nor exit is seen and the list is empty. The tool
/// is in the cut where the level is above the middle between the two; a stretch or a gap of fewer
/// than `kLeastRev` revolutions is none. Chatter hardly moves the level, for it is not forced.
[[nodiscard]] std::vector<Engagement> engagements(const std::vector<ForcedLevel>& levels);

/// Whether a stretch from `start_s` to `end_s` lies within so many revolutions of an entry (or an
/// exit) and ends there: what the change of engagement itself can give.
enum class AtEdge : unsigned char { none, entry, exit };
[[nodiscard]] AtEdge at_edge(const std::vector<Engagement>& cuts, double start_s, double end_s,
                             double within_s);

}  // namespace steadyrest::chatter::offline
