// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>

/// A second opinion that shares nothing with the collocation: the delay equation of one mode along
/// x, stepped by fourth-order Runge–Kutta over the spindle angle, the delayed displacement by cubic
/// Hermite interpolation.
namespace steadyrest::chatter::offline::test {

class RungeKutta {
 public:
  RungeKutta(const Process& process, double speed_rev_s, const Modulation& modulation,
             double depth_mm, std::size_t steps_per_pass, std::size_t passes)
      : mode_(process.modes[0]),
        depth_mm_(depth_mm),
        step_(2.0 * std::numbers::pi / static_cast<double>(process.tool.teeth) /
              static_cast<double>(steps_per_pass)),
        ring_(steps_per_pass) {
    const SpeedProfile profile(speed_rev_s, modulation);
    const CuttingCoefficients coefficients(process, 0.0);
    for (std::size_t i = 0; i < steps_per_pass * passes; ++i) {
      for (const double share : {1e-9, 0.5, 1.0 - 1e-9}) {
        const double angle = (static_cast<double>(i) + share) * step_;
        double h = 0.0;
        for (std::size_t j = 0; j < process.tool.teeth; ++j) {
          h += coefficients.stiffness(j, angle)(0, 0);
        }
        stage_.push_back({profile.speed_rad_s(angle), h});
      }
    }
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      ring_[i] = {std::sin(0.37 * static_cast<double>(i)) + 0.3, 0.0, 0.0};
    }
  }

  double log_radius(int periods) {
    double scale = 0.0;
    for (int period = 0; period < periods; ++period) {
      for (std::size_t i = 0; i < stage_.size(); i += 3) {
        advance(i);
      }
      log_size_.push_back(scale);
      scale += std::log(normalise());
    }
    return log_of_largest();
  }

 private:
  struct Stage {
    double speed, h;
  };
  struct State {
    double x, v;
  };
  struct Knot {
    double x, first, next;  // slopes right of the knot and left of the next one
  };

  [[nodiscard]] State rate(const Stage& at, const State& now, double before) const {
    return {now.v / at.speed, (-2.0 * mode_.damping_ratio * wn_ * now.v - wn_ * wn_ * now.x -
                               1000.0 / mode_.mass_kg * depth_mm_ * at.h * (now.x - before)) /
                                  at.speed};
  }

  /// One step, its three stages from `i` on.
  void advance(std::size_t i) {
    const Knot from = ring_[k_];
    const double to = ring_.size() > 1 ? ring_[(k_ + 1) % ring_.size()].x : s_.x;
    const double half = 0.5 * (from.x + to) + 0.125 * step_ * (from.first - from.next);
    const auto ahead = [&](const State& r, double by) {
      return State{s_.x + by * r.x, s_.v + by * r.v};
    };
    const State k1 = rate(stage_[i], s_, from.x);
    const State k2 = rate(stage_[i + 1], ahead(k1, 0.5 * step_), half);
    const State k3 = rate(stage_[i + 1], ahead(k2, 0.5 * step_), half);
    const State k4 = rate(stage_[i + 2], ahead(k3, step_), to);
    const State next{s_.x + step_ / 6.0 * (k1.x + 2.0 * k2.x + 2.0 * k3.x + k4.x),
                     s_.v + step_ / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
    ring_[k_] = {s_.x, k1.x, next.v / stage_[i + 2].speed};
    s_ = next;
    k_ = (k_ + 1) % ring_.size();
  }

  /// Stores the present vibration and scales it to size 1; returns its size before.
  double normalise() {
    std::vector<double> all{s_.x, s_.v / wn_};
    for (const Knot& knot : ring_) {
      all.push_back(knot.x);
    }
    double norm = 0.0;
    for (const double a : all) {
      norm += a * a;
    }
    norm = std::sqrt(norm);
    seen_.push_back(std::move(all));
    s_ = {s_.x / norm, s_.v / norm};
    for (Knot& knot : ring_) {
      knot = {knot.x / norm, knot.first / norm, knot.next / norm};
    }
    return norm;
  }

  /// y₂ = p·y₀ + q·y₁ by least squares; μ² = p + q·μ.
  [[nodiscard]] double log_of_largest() const {
    const std::size_t n = seen_.size();
    const double r1 = std::exp(log_size_[n - 2] - log_size_[n - 3]);
    const double r2 = std::exp(log_size_[n - 1] - log_size_[n - 3]);
    double aa = 0.0;
    double ab = 0.0;
    double bb = 0.0;
    double ac = 0.0;
    double bc = 0.0;
    for (std::size_t i = 0; i < seen_[0].size(); ++i) {
      const double a = seen_[n - 3][i];
      const double b = seen_[n - 2][i] * r1;
      const double c = seen_[n - 1][i] * r2;
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

  Mode mode_;
  double depth_mm_;
  double step_;  ///< rad
  double wn_ = 2.0 * std::numbers::pi * mode_.frequency_hz;
  std::vector<Stage> stage_;  ///< three per step: just inside its ends, and the middle
  std::vector<Knot> ring_;
  std::size_t k_ = 0;
  State s_{0.4, wn_};
  std::vector<std::vector<double>> seen_;
  std::vector<double> log_size_;
};

/// ln ρ over one period of `passes`, from the plane that the vibration settles on. Entry, exit and
/// the law's jumps must coincide with steps.
inline double log_radius_by_runge_kutta(const Process& process, double speed_rev_s,
                                        const Modulation& modulation, double depth_mm,
                                        std::size_t steps_per_pass, std::size_t passes,
                                        int periods) {
  return RungeKutta(process, speed_rev_s, modulation, depth_mm, steps_per_pass, passes)
      .log_radius(periods);
}

}  // namespace steadyrest::chatter::offline::test
