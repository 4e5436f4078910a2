// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/contour/offline/learn/in_force.hpp>
#include <steadyrest/contour/offline/learn/path_follower.hpp>
#include <steadyrest/contour/offline/learn/swapped_columns.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

constexpr std::size_t kFewestRows = 100;
constexpr double kOrderNearer = 0.1;  ///< of the mean square distance
constexpr double kOrderLeast_mm =
    0.05;                            ///< mean distance below which no order is told from another
constexpr double kOffPath = 0.1;     ///< share of the commands that makes other orders worth a look
constexpr double kOnPath = 0.8;      ///< share that shows that an order is the right one
constexpr double kAheadShare = 0.5;  ///< of the lag that is expected
constexpr double kAheadSamples = 2.0;
constexpr std::string_view kAxes = "xyz";

/// Which column is taken for each axis.
using Order = std::array<std::size_t, 3>;
constexpr Order kAsNamed = {0, 1, 2};
/// Of two axes, each pair.
constexpr std::array<Order, 3> kSwaps = {Order{1, 0, 2}, Order{2, 1, 0}, Order{0, 2, 1}};

Point in_order(const Point& of, const Order& order) noexcept {
  return {of[order[0]], of[order[1]], of[order[2]]};
}

double distance_mm2(const PartRecord& record, const Order& command, const Order& actual) {
  double sum = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    sum += geometry::norm_squared(geometry::subtract(in_order(record.command_mm[i], command),
                                                     in_order(record.actual_mm[i], actual)));
  }
  return sum / static_cast<double>(record.size());
}

/// How many of the commands that move follow the path.
double share_on_path(const PartRecord& record, const Order& order, kernel::signal::PathView path) {
  PathFollower follower(path, JudgeConfig{}.near_mm);
  std::size_t moving = 0;
  std::size_t on = 0;
  Point before = in_order(record.command_mm.front(), order);
  for (const Point& named : record.command_mm) {
    const Point command = in_order(named, order);
    const bool moves = command != before;
    before = command;
    const bool found = follower.next(command).has_value();
    moving += moves ? 1U : 0U;
    on += moves && found ? 1U : 0U;
  }
  return moving == 0 ? 1.0 : static_cast<double>(on) / static_cast<double>(moving);
}

/// The two axes of a swap: "x" and "y".
std::array<char, 2> axes_of(const Order& swap) noexcept {
  std::array<char, 2> out{};
  std::size_t found = 0;
  for (std::size_t i = 0; i < swap.size(); ++i) {
    if (swap[i] != i && found < out.size()) {
      out[found++] = kAxes[i];
    }
  }
  return out;
}

std::string on_one_side(const PartRecord& record, kernel::signal::PathView path) {
  const double as_named = distance_mm2(record, kAsNamed, kAsNamed);
  for (const Order& swap : kSwaps) {
    const double swapped = distance_mm2(record, kAsNamed, swap);
    if (as_named < kOrderLeast_mm * kOrderLeast_mm || swapped > kOrderNearer * as_named) {
      continue;
    }
    const bool commands = share_on_path(record, swap, path) > share_on_path(record, kAsNamed, path);
    const auto [a, b] = axes_of(swap);
    return fmt::format(
        "the columns {0}_{2}_mm and {1}_{2}_mm look swapped: the measured positions are {3:.3g} mm "
        "from the commanded ones, and {4:.3g} mm the other way round",
        a, b, commands ? "cmd" : "act", std::sqrt(as_named), std::sqrt(swapped));
  }
  return {};
}

std::string on_both_sides(const PartRecord& record, kernel::signal::PathView path) {
  const double as_named = share_on_path(record, kAsNamed, path);
  if (as_named > 1.0 - kOffPath) {
    return {};
  }
  for (const Order& swap : kSwaps) {
    const double swapped = share_on_path(record, swap, path);
    if (swapped > kOnPath && swapped > as_named + kOffPath) {
      const auto [a, b] = axes_of(swap);
      return fmt::format(
          "the columns of {0} and {1} look swapped ({0}_cmd_mm with {1}_cmd_mm, {0}_act_mm with "
          "{1}_act_mm): {2:.0f} % of the commands are on the program's path, and {3:.0f} % the "
          "other way round",
          a, b, 100.0 * as_named, 100.0 * swapped);
    }
  }
  return {};
}

/// How far an axis's measured position is behind the commanded one, s; 0 where it hardly moves.
double behind_s(const PartRecord& record, std::size_t axis) {
  constexpr double kLeastTravel_mm = 1.0;
  double lag_mm2_s = 0.0;
  double square = 0.0;
  double travel_mm = 0.0;
  for (std::size_t i = 1; i + 1 < record.size(); ++i) {
    const double dt = record.time_s[i + 1] - record.time_s[i - 1];
    const double moved = record.command_mm[i + 1][axis] - record.command_mm[i - 1][axis];
    const double v = moved / dt;
    lag_mm2_s += v * (record.command_mm[i][axis] - record.actual_mm[i][axis]);
    square += v * v;
    travel_mm += 0.5 * std::abs(moved);
  }
  return travel_mm < kLeastTravel_mm ? 0.0 : lag_mm2_s / square;
}

std::string with_each_other(const PartRecord& record, const ServoModels& model) {
  const std::array<double, 3> lags_s = first_lags_s(model);
  std::string columns;
  double most_s = 0.0;
  for (std::size_t i = 0; i < lags_s.size(); ++i) {
    const double ahead_s = -behind_s(record, i);
    if (ahead_s > std::max(kAheadShare * lags_s[i], kAheadSamples * record.period_s)) {
      columns +=
          fmt::format("{0}{1}_cmd_mm with {1}_act_mm", columns.empty() ? "" : ", ", kAxes[i]);
      most_s = std::max(most_s, ahead_s);
    }
  }
  return columns.empty() ? columns
                         : fmt::format(
                               "columns look swapped ({}): the measured positions are up "
                               "to {:.1f} ms ahead of the commanded ones",
                               columns, 1000.0 * most_s);
}

}  // namespace

std::string swapped_columns(const PartRecord& record, kernel::signal::PathView path,
                            const ServoModels& model) {
  if (record.size() < kFewestRows || path.empty()) {
    return {};
  }
  std::string said = on_one_side(record, path);
  if (said.empty()) {
    said = on_both_sides(record, path);
  }
  return said.empty() ? with_each_other(record, model) : said;
}

}  // namespace steadyrest::contour::offline
