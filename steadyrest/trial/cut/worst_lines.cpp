// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/worst_lines.hpp>

// The program lines with the largest errors, and the feed at which each would keep the limit: the
// table that tells a programmer where to change F.
namespace steadyrest::trial::cut {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;
using kernel::units::mm_min_from_mm_s;
using kernel::units::um_from_mm;

constexpr std::size_t kOfEachRun = 20;
constexpr std::size_t kLongestText = 120;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// e⁻³ = 5 % of the transient is left.
constexpr double kRunIn = 3.0;  ///< time constants 1/k until the steady state

/// Worst places of one line in both runs.
struct Pair {
  std::optional<LineError> without;
  std::optional<LineError> with;
};

double size_of(const std::optional<LineError>& error) {
  return error ? std::abs(error->contour_error_mm) : -1.0;
}

/// The linear axes present; for a rotary one a length has no servo gain.
template <class Visit>
void each_linear_axis(const Machine& machine, Visit visit) {
  for (const Axis& axis : machine.axes) {
    if (axis.present && !axis.rotary) {
      visit(axis);
    }
  }
}

// An arc longer than three time constants of the slowest axis: the closed form needs that.
bool steady(const LineError& worst, const Machine& machine) {
  double slowest_1_s = std::numeric_limits<double>::infinity();
  each_linear_axis(machine, [&slowest_1_s](const Axis& axis) {
    slowest_1_s = std::min(slowest_1_s, axis.servo_gain_1_s);
  });
  return worst.arc_radius_mm > 0.0 &&
         worst.arc_length_mm * slowest_1_s >= kRunIn * worst.path_speed_mm_s;
}

/// The axis that bears least sets the arc's feed; NaN where every speed keeps the limit. A limit
/// beyond the radius is no limit.
double closed_form_mm_s(double radius_mm, const Machine& machine) {
  const double limit_mm = machine.contour.limit_mm;
  double least_mm_s = std::numeric_limits<double>::infinity();
  if (!(limit_mm < radius_mm)) {
    return kNone;
  }
  each_linear_axis(machine, [&](const Axis& axis) {
    const auto found = contour::offline::circle_limit(
        {axis.servo_gain_1_s, axis.feed_forward, axis.velocity_lag_s}, radius_mm, limit_mm);
    least_mm_s = found ? std::min(least_mm_s, found->speed_mm_s) : least_mm_s;
  });
  return std::isfinite(least_mm_s) ? least_mm_s : kNone;
}

// A very short line may have a sample in one run only.
std::map<std::uint32_t, Pair> by_line(const Recorder& without, const Recorder& with) {
  std::map<std::uint32_t, Pair> out;
  for (const LineError& error : without.line_errors()) {
    out[error.line].without = error;
  }
  for (const LineError& error : with.line_errors()) {
    out[error.line].with = error;
  }
  return out;
}

/// With the layer; where that kept the limit, a faster run without the layer that also kept it says
/// more: it proves that feed.
HeldFeed held_feed(const Pair& pair, const Machine& machine) {
  const LineError& judged = pair.with ? *pair.with : *pair.without;
  const HeldFeed held = held_feed(judged, machine);
  const bool both = pair.with && pair.without && held.by == HeldBy::driven;
  if (both && size_of(pair.without) <= machine.contour.limit_mm) {
    return {std::max(held.feed_mm_s, pair.without->path_speed_mm_s), HeldBy::driven};
  }
  return held;
}

WorstLine row_of(std::uint32_t line, const Pair& pair, const Machine& machine) {
  const LineError& judged = pair.with ? *pair.with : *pair.without;
  const auto um = [](const auto& e) { return e ? um_from_mm(e->contour_error_mm) : kNone; };
  const auto feed = [](const auto& e) { return e ? mm_min_from_mm_s(e->path_speed_mm_s) : kNone; };
  const HeldFeed held = held_feed(pair, machine);
  return {.line = line,
          .text = {},
          .without_um = um(pair.without),
          .with_um = um(pair.with),
          .feed_without_mm_min = feed(pair.without),
          .feed_with_mm_min = feed(pair.with),
          .radius_mm = judged.arc_radius_mm > 0.0 ? judged.arc_radius_mm : kNone,
          .hold_feed_mm_min = mm_min_from_mm_s(held.feed_mm_s),
          .held_by = held.by};
}

// Read again rather than kept: programs have millions of lines, the table forty.
void add_texts(const std::filesystem::path& program, std::vector<WorstLine>& lines) {
  std::ifstream file(program, std::ios::binary);
  std::string text;
  for (std::uint32_t number = 1; std::getline(file, text); ++number) {
    const auto entry = std::ranges::find(lines, number, &WorstLine::line);
    if (entry == lines.end()) {
      continue;
    }
    if (!text.empty() && text.back() == '\r') {
      text.pop_back();
    }
    entry->text = text.substr(0, kLongestText);
  }
}

}  // namespace

HeldFeed held_feed(const LineError& worst, const Machine& machine) {
  // Away from steady arcs ε grows with v² (leading term), so the feed scales with √(limit/ε).
  const double share = machine.contour.limit_mm / std::abs(worst.contour_error_mm);
  const HeldFeed recorded =
      share >= 1.0 ? HeldFeed{worst.path_speed_mm_s, HeldBy::driven}
                   : HeldFeed{worst.path_speed_mm_s * std::sqrt(share), HeldBy::record};
  if (!steady(worst, machine)) {
    return recorded;
  }
  const HeldFeed closed{closed_form_mm_s(worst.arc_radius_mm, machine), HeldBy::closed_form};
  // Over the limit at a feed that the radius would bear: the arc is not the cause.
  return recorded.by == HeldBy::record && !(worst.path_speed_mm_s > closed.feed_mm_s) ? recorded
                                                                                      : closed;
}

// The twenty worst of each run: what the layer has cured matters as much as what it has not.
std::vector<WorstLine> worst_lines(const std::filesystem::path& program, const Machine& machine,
                                   const Recorder& without, const Recorder& with) {
  const std::map<std::uint32_t, Pair> all = by_line(without, with);
  std::vector<std::uint32_t> order;
  order.reserve(all.size());
  for (const auto& [line, pair] : all) {
    order.push_back(line);
  }
  std::map<std::uint32_t, bool> chosen;
  for (const auto run : {&Pair::without, &Pair::with}) {
    // Stable, so that equal errors keep the program's order.
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::uint32_t line) { return size_of(all.at(line).*run); });
    for (std::size_t i = 0; i < std::min(order.size(), kOfEachRun); ++i) {
      chosen[order[i]] = true;
    }
  }
  std::vector<WorstLine> out;
  for (const std::uint32_t line : order) {
    if (chosen[line]) {
      out.push_back(row_of(line, all.at(line), machine));
    }
  }
  add_texts(program, out);
  return out;
}

}  // namespace steadyrest::trial::cut
