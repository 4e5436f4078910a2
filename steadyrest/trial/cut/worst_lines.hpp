// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/trial/cut/recorder.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

namespace steadyrest::trial::cut {

/// A line's feed in the cut and the feed that it would bear.
struct HeldFeed {
  double feed_mm_s = 0.0;  ///< NaN: any
  HeldBy by = HeldBy::driven;
};

/// The feed at which a line keeps the machine's contour limit, from its worst place in a cut.
///
/// On an arc long enough for the steady state (3/k at the actual speed, k the servo gain): the
/// closed form of contour/offline/closed_form.hpp for the slowest of the linear axes, unless the
/// arc exceeded the limit at a slower feed than that (at its entry, say). Elsewhere from the
/// record: a line that kept the limit keeps it at its actual feed; one that did not would at
/// v·√(limit/ε), because the error of a lagging servo grows with the square of the speed on every
/// curve. Where the error has other causes (friction at a reversal) that is too slow or too fast;
/// the report names the source of each feed.
[[nodiscard]] HeldFeed held_feed(const LineError& worst, const kernel::machine::Machine& machine);

/// The lines with the largest errors with the layer and those with the largest without it, sorted
/// by error with the layer. Texts come from the program's file; if it cannot be read they stay
/// empty.
[[nodiscard]] std::vector<WorstLine> worst_lines(const std::filesystem::path& program,
                                                 const kernel::machine::Machine& machine,
                                                 const Recorder& without, const Recorder& with);

}  // namespace steadyrest::trial::cut
