// SPDX-License-Identifier: Apache-2.0
// Summed at a complex z, the series is the ordinary differential equation of the cut with the
// stiffness z·H(θ), stepped by Runge and Kutta.
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/piece_terms.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using PieceComplex = std::complex<double>;

constexpr std::size_t kPieces = 8;
constexpr double kPieceSpeed_rev_s = 5000.0 / 60.0;
constexpr double kPieceBegin_rad = 0.1;
constexpr double kPiece_rad = 3.0 / kPieces;

/// Rates of q and q̇/ω of each mode.
Eigen::VectorXcd rates_of(const Process& p, const Eigen::Matrix2d& h, PieceComplex z,
                          const Eigen::VectorXcd& s) {
  Eigen::Vector2cd x = Eigen::Vector2cd::Zero();
  for (std::size_t m = 0; m < p.modes.size(); ++m) {
    x += s[static_cast<Index>(2 * m)] * Eigen::Vector2d(p.modes[m].shape[0], p.modes[m].shape[1]);
  }
  const Eigen::Vector2cd force = -z * (h * x);
  Eigen::VectorXcd out(s.size());
  for (std::size_t m = 0; m < p.modes.size(); ++m) {
    const Mode& mode = p.modes[m];
    const double w = 2.0 * std::numbers::pi * mode.frequency_hz;
    const auto at = static_cast<Index>(2 * m);
    const PieceComplex push = mode.shape[0] * force[0] + mode.shape[1] * force[1];
    out[at] = w * s[at + 1];
    out[at + 1] =
        -w * s[at] - 2.0 * mode.damping_ratio * w * s[at + 1] + 1000.0 / mode.mass_kg / w * push;
  }
  return out;
}

Eigen::VectorXcd stepped(const Process& p, std::size_t piece, PieceComplex z, Eigen::VectorXcd s) {
  const CuttingCoefficients cutting(p, 0.0);
  constexpr int kSteps = 3000;
  const double dt = kPiece_rad / (2.0 * std::numbers::pi * kPieceSpeed_rev_s) / kSteps;
  const auto h_at = [&](double step) {
    const double angle =
        kPieceBegin_rad + kPiece_rad * (static_cast<double>(piece) + step / kSteps);
    return Eigen::Matrix2d(cutting.stiffness(0, angle) + cutting.stiffness(1, angle));
  };
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::VectorXcd k1 = rates_of(p, h_at(i), z, s);
    const Eigen::VectorXcd k2 = rates_of(p, h_at(i + 0.5), z, s + 0.5 * dt * k1);
    const Eigen::VectorXcd k3 = rates_of(p, h_at(i + 0.5), z, s + 0.5 * dt * k2);
    const Eigen::VectorXcd k4 = rates_of(p, h_at(i + 1.0), z, s + dt * k3);
    s += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return s;
}

void expect_pieces(const Process& p) {
  const std::size_t order = 2 * p.modes.size();
  const CuttingCoefficients cutting(p, 0.0);
  const PieceTerms terms(
      {p, cutting, kPieceSpeed_rev_s, kPieceBegin_rad, kPiece_rad * kPieces, kPieces}, order, 2.0);
  EXPECT_GT(terms.count(), 4U);
  EXPECT_LT(terms.count(), 20U) << "they fall as 1/(2k)!";
  for (const PieceComplex z : {PieceComplex(0.0, 0.0), PieceComplex(1.2, 1.6)}) {
    for (std::size_t column = 0; column < order; ++column) {
      const Eigen::VectorXcd unit =
          Eigen::VectorXcd::Unit(static_cast<Index>(order), static_cast<Index>(column));
      const Eigen::VectorXcd want = stepped(p, 5, z, unit);
      for (std::size_t row = 0; row < order; ++row) {
        PieceComplex sum = 0.0;
        for (std::size_t k = terms.count(); k-- > 0;) {
          sum = sum * z + terms.at(k, 5, row * order + column);
        }
        EXPECT_LT(std::abs(sum - want[static_cast<Index>(row)]), 1e-10) << row << column << z;
      }
    }
  }
}

TEST(PieceTerms, OfOneModeSumToTheSteppedEquation) {
  expect_pieces(test::benchmark_cut(1.0, Direction::up));
}

TEST(PieceTerms, OfModesAcrossEachOtherSumToTheSteppedEquation) {
  Process p = test::benchmark_cut(1.0, Direction::up);
  p.modes.push_back({{-0.6, 0.8}, 700.0, 0.03, 0.06});
  expect_pieces(p);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
