// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/cut/cut_runs.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

/// Every way to cut the part, side by side.
namespace steadyrest::apps::cli::cut {

struct WaysOptions {
  bool quick = false;
  bool all = false;
  bool ways = false;
  bool curve = false;
};

void add_ways_options(Verb& verb, WaysOptions& options);

/// The layer of this machine may move the axes off the path.
[[nodiscard]] bool permits_offsets(const Setup& setup);

/// A run beyond those that `cut` makes anyway: the part by the layer in one way, or at another
/// limit.
struct Further {
  trial::cut::Way way = trial::cut::Way::feed_override;
  double curve_limit_um = 0.0;  ///< > 0: a point of the curve instead
  std::string get;              ///< what gives it
  Asked asked;
};

/// Of the program, or of the original of a changed one (`changed`).
[[nodiscard]] std::vector<Further> further_runs(const Setup& setup, const PathPointer& path,
                                                bool changed, const WaysOptions& options);

/// What has been cut.
struct Ways {
  std::vector<trial::cut::WayFigures> ways;
  std::vector<trial::cut::CurvePoint> curve;

  /// Orders them for people.
  void sort();
};

/// The keys `ways` and `curve`; returns their text.
[[nodiscard]] std::string put_ways(Answer& answer, const Ways& ways, double limit_mm);

}  // namespace steadyrest::apps::cli::cut
