// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/runge_kutta.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::kSanitized;

constexpr double kWhole = 2.0 * std::numbers::pi;
constexpr int kSlices = 40;  ///< of a helical edge

/// Forces over displacement and over velocity, per depth, with the spindle at θ: Altintas and
/// Budak's equations of process.hpp, slice by slice.
struct FrozenForces {
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();  ///< N/mm²
  Eigen::Matrix2d damping = Eigen::Matrix2d::Zero();    ///< N·s/mm²

  FrozenForces(const Process& p, double depth_mm, double speed_rev_s, double angle_rad) {
    const double lag = 2.0 * depth_mm * std::tan(p.tool.helix_rad) / p.tool.diameter_mm;
    double tooth_rad = angle_rad;
    for (std::size_t j = 0; j < p.tool.teeth; ++j) {
      tooth_rad -= j == 0 ? 0.0 : p.pitch_rad(j);
      for (int slice = 0; slice < kSlices; ++slice) {
        const double back = lag * (slice + 0.5) / kSlices;
        const double turns = (tooth_rad - back) / kWhole;
        const double phi = (turns - std::floor(turns)) * kWhole;
        if (phi < p.entry_rad() || phi > p.exit_rad()) {
          continue;
        }
        const Eigen::Vector2d chip(std::sin(phi), std::cos(phi));
        const Eigen::Vector2d cut(std::cos(phi), -std::sin(phi));
        stiffness +=
            (p.cut.tangential_n_mm2 * cut + p.cut.radial_n_mm2 * chip) * chip.transpose() / kSlices;
        damping += p.cut.process_damping_n_mm /
                   (std::numbers::pi * p.tool.diameter_mm * speed_rev_s) * chip * chip.transpose() /
                   kSlices;
      }
    }
  }
};

/// Largest |Im λ| of the modes with the spindle frozen at θ and the previous surface fixed.
double oscillation_rad_s(const Process& p, double depth_mm, const FrozenForces& forces) {
  const auto modes = static_cast<Eigen::Index>(p.modes.size());
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(2 * modes, 2 * modes);
  for (Eigen::Index k = 0; k < modes; ++k) {
    const Mode& mode = p.modes[static_cast<std::size_t>(k)];
    const double w = kWhole * mode.frequency_hz;
    // State q and q̇/ω, which keeps the numbers near one another.
    rate(k, modes + k) = w;
    rate(modes + k, k) = -w;
    rate(modes + k, modes + k) = -2.0 * mode.damping_ratio * w;
    for (Eigen::Index l = 0; l < modes; ++l) {
      const Mode& other = p.modes[static_cast<std::size_t>(l)];
      const Eigen::Vector2d to(mode.shape[0], mode.shape[1]);
      const Eigen::Vector2d from(other.shape[0], other.shape[1]);
      const double per_mass = 1000.0 * depth_mm / (mode.mass_kg * w);
      rate(modes + k, l) -= per_mass * to.dot(forces.stiffness * from);
      rate(modes + k, modes + l) -=
          per_mass * to.dot(forces.damping * from) * kWhole * other.frequency_hz;
    }
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(rate, false);
  return eigen.eigenvalues().imag().cwiseAbs().maxCoeff();
}

double most_oscillation_rad_s(const Process& p, double depth_mm, double speed_rev_s) {
  double most = 0.0;
  for (int i = 0; i < 90; ++i) {
    const FrozenForces forces(p, depth_mm, speed_rev_s, kWhole * (i + 0.123) / 90.0);
    most = std::max(most, oscillation_rad_s(p, depth_mm, forces));
  }
  return most;
}

Process many_teeth(std::size_t teeth) {
  Process p = benchmark_cut(1.0, Direction::up);
  p.tool.teeth = teeth;
  return p;
}

class Draw {
 public:
  Process process() {
    Process p = many_teeth(1 + random_() % 24);
    p.cut.radial_immersion = between(0.02, 1.0);
    p.cut.direction = random_() % 2 == 0 ? Direction::up : Direction::down;
    p.tool.helix_rad = random_() % 2 == 0 ? 0.0 : between(0.1, 1.0);
    p.cut.radial_n_mm2 = between(-1500.0, 1500.0);
    p.cut.process_damping_n_mm = random_() % 3 == 0 ? between(10.0, 3000.0) : 0.0;
    if (p.tool.teeth > 1 && random_() % 2 == 0) {
      uneven(p);
    }
    p.modes.clear();
    const std::size_t modes = 1 + random_() % 4;
    for (std::size_t k = 0; k < modes; ++k) {
      const double angle = random_() % 2 == 0 ? 0.0 : between(0.0, kWhole);
      p.modes.push_back({.shape = {std::cos(angle), std::sin(angle)},
                         .frequency_hz = between(100.0, 2000.0),
                         .damping_ratio = between(0.001, 0.99),
                         .mass_kg = between(0.01, 1.0)});
    }
    return p;
  }

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  void uneven(Process& p) {
    double sum = 0.0;
    for (std::size_t j = 0; j < p.tool.teeth; ++j) {
      p.tool.pitch_rad.push_back(between(0.5, 1.5));
      sum += p.tool.pitch_rad.back();
    }
    for (double& pitch : p.tool.pitch_rad) {
      pitch *= kWhole / sum;
    }
  }

  std::mt19937_64 random_{11};
};

TEST(Fastest, NoFrozenCutOscillatesFaster) {
  Draw draw;
  double nearest = 0.0;
  for (int i = 0; i < (kSanitized ? 5 : 150); ++i) {
    const Process p = draw.process();
    const double depth_mm = draw.between(0.1, 20.0);
    const double speed_rev_s = draw.between(1.0, 300.0);
    const double bound = fastest_rad_s(p, depth_mm, speed_rev_s);
    const double found = most_oscillation_rad_s(p, depth_mm, speed_rev_s);
    EXPECT_LE(found, bound * (1.0 + 1e-9)) << i;
    nearest = std::max(nearest, found / bound);
  }
  EXPECT_GT(nearest, kSanitized ? 0.0 : 0.9);
}

// The bound is reached where the chip's direction is the mode's and only the radial force acts: z
// teeth on one mode, or one tooth on two modes that move as one, are as stiff as z times the one.
TEST(Fastest, IsMetByTeethAndModesThatPushTogether) {
  for (const std::size_t teeth : {8U, 20U}) {
    Process p = many_teeth(teeth);
    p.cut.tangential_n_mm2 = 1e-3;
    p.cut.radial_n_mm2 = 900.0;
    const double bound = fastest_rad_s(p, 5.0, 20.0);
    EXPECT_NEAR(most_oscillation_rad_s(p, 5.0, 20.0), bound, 1e-3 * bound) << teeth;
    // z/2 teeth in the slot, half of whose stiffness is along x.
    const double w = kWhole * 922.0;
    const double per_tooth = 5.0 * 900.0 * 1000.0 / 0.03993;
    EXPECT_NEAR(bound, std::sqrt(w * w + per_tooth * static_cast<double>(teeth) / 4.0),
                1e-6 * bound);
    p.modes.push_back(p.modes[0]);
    const double both = fastest_rad_s(p, 5.0, 20.0);
    EXPECT_NEAR(most_oscillation_rad_s(p, 5.0, 20.0), both, 1e-3 * both) << teeth;
  }
}

// Its purpose: enough nodes where many teeth stiffen a light tool many times over.
TEST(Fastest, MultipliersOfManyTeethAreThoseOfRungeAndKutta) {
  Process p = many_teeth(64);
  p.modes[0].damping_ratio = 0.05;
  const double depth_mm = 12.0;
  const double speed_rev_s = 300.0 / 60.0;
  auto cycle =
      DelayCycle::make(
          p,
          {.speed_rev_s = speed_rev_s, .modulation = {}, .course = {}, .most_depth_mm = depth_mm})
          .value();
  cycle.set_depth(depth_mm);
  EXPECT_NEAR(stability(cycle, {}).log_radius,
              log_radius_by_runge_kutta(p, speed_rev_s, {}, depth_mm, 4000, 1, 60), 1e-7);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
