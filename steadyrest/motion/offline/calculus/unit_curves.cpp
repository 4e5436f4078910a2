// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/calculus/unit_calculus.hpp>
#include <steadyrest/motion/offline/calculus/unit_curves.hpp>

// The figures of the paper as curves, each point by the equation itself.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::units::mm_s_from_mm_min;

/// `points` abscissas from low to high, including both ends. `low` = 0 is omitted: no equation
/// holds there.
Result<Curve> sampled(std::string name, double low, double high, std::size_t points,
                      const std::function<Number(double)>& law) {
  if (points < 2 || !(high > low)) {
    return refuse(fmt::format("a curve of {} points from {:.10g} to {:.10g}", points, low, high),
                  "give at least 2 points and a rising range");
  }
  Curve curve{std::move(name), {}, {}};
  for (std::size_t i = low == 0.0 ? 1 : 0; i < points; ++i) {
    const double x = low + (high - low) * static_cast<double>(i) / static_cast<double>(points - 1);
    const Number y = law(x);
    if (!y) {
      return std::unexpected(y.error());
    }
    curve.x.push_back(x);
    curve.y.push_back(*y);
  }
  return curve;
}

// All or none: a figure with a curve missing misleads.
Curves collect(std::initializer_list<Result<Curve>> parts) {
  std::vector<Curve> out;
  for (const Result<Curve>& part : parts) {
    if (!part) {
      return std::unexpected(part.error());
    }
    out.push_back(*part);
  }
  return out;
}

/// One curve from 0 on for each cycle.
Curves by_cycle(std::span<const double> cycles_hz, double high, std::size_t points,
                const std::function<Number(double cycle_hz, double x)>& law) {
  std::vector<Curve> out;
  for (const double cycle_hz : cycles_hz) {
    auto curve = sampled(fmt::format("{:g} Hz", cycle_hz), 0.0, high, points,
                         [&](double x) { return law(cycle_hz, x); });
    if (!curve) {
      return std::unexpected(curve.error());
    }
    out.push_back(std::move(*curve));
  }
  return out;
}

}  // namespace

Curves figure_3a(double count_mm, std::span<const double> cycles_hz, double max_feed_mm_min,
                 std::size_t points) {
  return by_cycle(cycles_hz, max_feed_mm_min, points, [&](double cycle_hz, double feed_mm_min) {
    return counts_per_tick({count_mm, cycle_hz}, mm_s_from_mm_min(feed_mm_min));
  });
}

Curves figure_3b(double count_mm, std::span<const double> cycles_hz, double max_overload_g,
                 std::size_t points) {
  return by_cycle(cycles_hz, max_overload_g, points, [&](double cycle_hz, double overload) {
    const Number a_mm_s2 = acceleration_of_overload_mm_s2(overload);
    return a_mm_s2 ? counts_per_tick2({count_mm, cycle_hz}, *a_mm_s2) : a_mm_s2;
  });
}

Curves figure_5(double max_frequency_hz, double lead_mm, double min_feed_mm_min,
                double max_feed_mm_min, std::size_t points) {
  const auto lines = [&](double feed_mm_min) {
    return lines_for_feed(max_frequency_hz, lead_mm, mm_s_from_mm_min(feed_mm_min));
  };
  const auto count_um = [&](double feed_mm_min) -> Number {
    const Number z = lines(feed_mm_min);
    const Number count = z ? count_of_lines_mm(lead_mm, *z) : z;
    return count ? Number(kernel::units::um_from_mm(*count)) : count;
  };
  return collect({sampled("lines per revolution", min_feed_mm_min, max_feed_mm_min, points, lines),
                  sampled("count in µm", min_feed_mm_min, max_feed_mm_min, points, count_um)});
}

}  // namespace steadyrest::motion::offline
