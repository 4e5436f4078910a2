// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>

/// A second opinion that shares nothing with the collocation: the delay equation of one mode along
/// x stepped by Runge and Kutta's rule of fourth order over the spindle's angle, the delayed
/// displacement by Hermite's cubic.
namespace steadyrest::chatter::offline::test {

/// ln ρ over one period of `passes`, from the plane that the vibration settles on. Entry, exit and
/// the law's jumps must fall on the steps.
inline double log_radius_by_runge_kutta(const Process& process, double speed_rev_s,
                                        const Modulation& modulation, double depth_mm,
                                        std::size_t steps_per_pass, std::size_t passes,
                                        int periods) {
  const Mode& mode = process.modes[0];
  const double wn = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double pass_rad = 2.0 * std::numbers::pi / static_cast<double>(process.tool.teeth);
  const std::size_t m = steps_per_pass;
  const double step = pass_rad / static_cast<double>(m);
  const SpeedProfile profile(speed_rev_s, modulation);
  const CuttingCoefficients coefficients(process, 0.0);
  struct Stage {
    double speed, h;
  };
  std::vector<Stage> stage;  // three in each step: just inside of its ends, and the middle
  for (std::size_t i = 0; i < m * passes; ++i) {
    for (const double share : {1e-9, 0.5, 1.0 - 1e-9}) {
      const double angle = (static_cast<double>(i) + share) * step;
      double h = 0.0;
      for (std::size_t j = 0; j < process.tool.teeth; ++j) {
        h += coefficients.stiffness(j, angle)(0, 0);
      }
      stage.push_back({profile.speed_rad_s(angle), h});
    }
  }
  struct State {
    double x, v;
  };
  struct Knot {
    double x, first, next;  // slopes right of the knot and left of the next one
  };
  std::vector<Knot> ring(m);
  for (std::size_t i = 0; i < m; ++i) {
    ring[i] = {std::sin(0.37 * static_cast<double>(i)) + 0.3, 0.0, 0.0};
  }
  State s{0.4, wn};
  const auto rate = [&](const Stage& at, const State& now, double before) {
    return State{now.v / at.speed, (-2.0 * mode.damping_ratio * wn * now.v - wn * wn * now.x -
                                    1000.0 / mode.mass_kg * depth_mm * at.h * (now.x - before)) /
                                       at.speed};
  };
  std::vector<std::vector<double>> seen;
  std::vector<double> log_size;
  double scale = 0.0;
  std::size_t k = 0;
  for (int period = 0; period < periods; ++period) {
    for (std::size_t i = 0; i < m * passes; ++i, k = (k + 1) % m) {
      const Knot from = ring[k];
      const double to = m > 1 ? ring[(k + 1) % m].x : s.x;
      const double half = 0.5 * (from.x + to) + 0.125 * step * (from.first - from.next);
      const auto ahead = [&](const State& r, double by) {
        return State{s.x + by * r.x, s.v + by * r.v};
      };
      const State k1 = rate(stage[3 * i], s, from.x);
      const State k2 = rate(stage[3 * i + 1], ahead(k1, 0.5 * step), half);
      const State k3 = rate(stage[3 * i + 1], ahead(k2, 0.5 * step), half);
      const State k4 = rate(stage[3 * i + 2], ahead(k3, step), to);
      const State next{s.x + step / 6.0 * (k1.x + 2.0 * k2.x + 2.0 * k3.x + k4.x),
                       s.v + step / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
      ring[k] = {s.x, k1.x, next.v / stage[3 * i + 2].speed};
      s = next;
    }
    std::vector<double> all{s.x, s.v / wn};
    for (const Knot& knot : ring) {
      all.push_back(knot.x);
    }
    double norm = 0.0;
    for (const double a : all) {
      norm += a * a;
    }
    norm = std::sqrt(norm);
    seen.push_back(all);
    log_size.push_back(scale);
    scale += std::log(norm);
    s = {s.x / norm, s.v / norm};
    for (Knot& knot : ring) {
      knot = {knot.x / norm, knot.first / norm, knot.next / norm};
    }
  }
  // y₂ = p·y₀ + q·y₁ in the least squares; μ² = p + q·μ.
  const std::size_t n = seen.size();
  const double r1 = std::exp(log_size[n - 2] - log_size[n - 3]);
  const double r2 = std::exp(log_size[n - 1] - log_size[n - 3]);
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  double ac = 0.0;
  double bc = 0.0;
  for (std::size_t i = 0; i < seen[0].size(); ++i) {
    const double a = seen[n - 3][i];
    const double b = seen[n - 2][i] * r1;
    const double c = seen[n - 1][i] * r2;
    aa += a * a;
    ab += a * b;
    bb += b * b;
    ac += a * c;
    bc += b * c;
  }
  const double det = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / det;
  const double q = (aa * bc - ab * ac) / det;
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * q * q + p));
  return std::log(std::max(std::abs(0.5 * q + root), std::abs(0.5 * q - root)));
}

}  // namespace steadyrest::chatter::offline::test
