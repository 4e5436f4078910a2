// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/depth/limit_depth.hpp>

// Marches up from below instead of bisecting the whole range: a cut may be stable again above an
// unstable island, and the lowest crossing is the one that a tool meets first.
namespace steadyrest::chatter::offline {

namespace {
constexpr double kFirst = 1.0 / 256.0;  ///< of the greatest depth
constexpr double kLeastFirst = 1e-7;
// ln ρ changes on the scale of the depth itself, so proportional steps resolve it equally
// everywhere.
constexpr double kGrowth = 0.06;  ///< step over depth
constexpr double kGolden = 0.3819660112501051;
constexpr double kNarrowest = 1e-4;  ///< of the depth: thinner islands are ignored
constexpr double kPeak = 3.0;  ///< a maximum may exceed the middle by this times the side fall
constexpr int kMostSections = 40;

}  // namespace

// Small gain: a·Σ‖H_j‖·max|1 − e^{−iωT}|·max‖G(iω)‖ < 1 with ‖H_j‖ ≤ |(Kt, Kr)| and
// |1 − e^{−iωT}| ≤ 2. |G| of a mode is largest, 1/(2ζ√(1−ζ²)·k), at ω·√(1−2ζ²); from ζ = 1/√2 on it
// has no peak and is largest at ω = 0, 1/k.
double safe_depth_mm(const Process& process) {
  double most_mm_n = 0.0;
  for (const Mode& mode : process.modes) {
    const double w = 2.0 * std::numbers::pi * mode.frequency_hz;
    const double z = mode.damping_ratio;
    const double peak = 2.0 * z * z < 1.0 ? 1.0 / (2.0 * z * std::sqrt(1.0 - z * z)) : 1.0;
    most_mm_n += peak * 1000.0 / (mode.mass_kg * w * w);
  }
  return 1.0 / (2.0 * static_cast<double>(process.tool.teeth) * most_mm_n *
                std::hypot(process.cut.tangential_n_mm2, process.cut.radial_n_mm2));
}

std::optional<double> island_mm(DepthLine& line, const std::array<double, 3>& depth_mm,
                                const std::array<double, 3>& log_radius) {
  auto [a, m, b] = depth_mm;
  auto [fa, fm, fb] = log_radius;
  for (int i = 0; i < kMostSections && b - a > kNarrowest * b; ++i) {
    // The greatest possible height: the steeper fall extended over the top. ln ρ is smooth where
    // the leading multiplier does not change, so it cannot rise much more steeply near the top than
    // it falls at the sides.
    const double slope = std::max((fm - fa) / (m - a), (fm - fb) / (b - m));
    if (fm + kPeak * slope * std::max(m - a, b - m) < 0.0) {
      return std::nullopt;
    }
    // Golden section of the larger side keeps the three depths in proportion.
    const double x = m - a > b - m ? m - kGolden * (m - a) : m + kGolden * (b - m);
    const double fx = line.log_radius(x);
    if (fx >= 0.0) {
      return x;
    }
    if (fx > fm) {
      (x < m ? b : a) = m;
      (x < m ? fb : fa) = fm;
      m = x;
      fm = fx;
    } else {
      (x < m ? a : b) = x;
      (x < m ? fa : fb) = fx;
    }
  }
  return std::nullopt;
}

std::optional<double> limit_depth_mm(DepthLine& line, double most_depth_mm, double from_mm) {
  const double first = std::clamp(safe_depth_mm(line.process()), kLeastFirst * most_depth_mm,
                                  kFirst * most_depth_mm);
  std::array<double, 3> depth{from_mm, 0.0, 0.0};
  std::array<double, 3> log_radius{line.log_radius(from_mm), 0.0, 0.0};
  // The hint was too deep: start at 0, where every cut is stable.
  if (log_radius[0] >= 0.0) {
    depth[0] = 0.0;
    log_radius[0] = line.log_radius(0.0);
  }
  std::size_t seen = 1;
  while (depth[seen - 1] < most_depth_mm) {
    const double low = depth[seen - 1];
    // Even steps near 0, then proportional to the depth.
    const double high = std::min(most_depth_mm, low + std::max(first, kGrowth * low));
    const double log_high = line.log_radius(high);
    if (seen == 3) {
      std::shift_left(depth.begin(), depth.end(), 1);
      std::shift_left(log_radius.begin(), log_radius.end(), 1);
      --seen;
    }
    depth[seen] = high;
    log_radius[seen] = log_high;
    ++seen;
    // Three depths in a row with the middle one highest: an island may hide between them.
    const bool peak = seen == 3 && log_radius[1] >= log_radius[0] && log_radius[1] > log_high;
    if (peak && log_high < 0.0) {
      if (const auto island = island_mm(line, depth, log_radius)) {
        return line.crossing_mm(depth[0], log_radius[0], *island, line.log_radius(*island));
      }
    }
    if (log_high >= 0.0) {
      return line.crossing_mm(low, log_radius[seen - 2], high, log_high);
    }
  }
  return std::nullopt;
}

kernel::outcome::Result<std::optional<double>> limit_depth_mm(const Process& process,
                                                              double speed_rev_s,
                                                              const Modulation& modulation,
                                                              double most_depth_mm) {
  auto line = DepthLine::make(process, speed_rev_s, modulation, most_depth_mm);
  if (!line) {
    return std::unexpected(line.error());
  }
  return limit_depth_mm(*line, most_depth_mm);
}

}  // namespace steadyrest::chatter::offline
