// SPDX-License-Identifier: Apache-2.0
// The collocated responses against textbook solutions of m·q̈ + c·q̇ + k·q = F.
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;

constexpr double kFree_rad_s = 2.0 * std::numbers::pi * 922.0;  ///< of benchmark_cut()
constexpr double kPiece_s = 4e-4;                               ///< a third of a period
constexpr Index kAnswerNodes = 14;

Process damped(double ratio) {
  Process p = test::benchmark_cut(1.0, Direction::up);
  p.modes[0].damping_ratio = ratio;
  return p;
}

ModalAnswers answers_of(const Process& p, Index directions = 1) {
  return modal_answers(p, GaussNodes::of(kAnswerNodes),
                       Eigen::VectorXd::Constant(kAnswerNodes, kPiece_s), directions, true);
}

// After k damped periods a released mode is at e^(−kδ), δ = 2πζ/√(1 − ζ²).
TEST(FreeAnswer, FallsByTheLogarithmicDecrement) {
  for (const double ratio : {0.0, 0.011, 0.3, 0.9}) {
    const double root = std::sqrt(1.0 - ratio * ratio);
    const double decrement = 2.0 * std::numbers::pi * ratio / root;
    for (const int k : {1, 3}) {
      const Eigen::MatrixXd e = free_answer(damped(ratio), k / (922.0 * root));
      EXPECT_NEAR(e(0, 0), std::exp(-k * decrement), 1e-12) << ratio;
      EXPECT_NEAR(e(1, 0), 0.0, 1e-12) << "at its peak again";
    }
  }
}

TEST(FreeAnswer, OfTwoTimesIsOneAfterTheOther) {
  const Process p = damped(0.2);
  const Eigen::MatrixXd both = free_answer(p, 3e-4) * free_answer(p, 5e-4);
  EXPECT_LT((both - free_answer(p, 8e-4)).norm(), 1e-14);
  // Its eigenvalues are the multipliers, one of each pair.
  const Eigen::VectorXcd values = free_answer(p, 8e-4).eigenvalues();
  const std::complex<double> mu = free_multipliers(p, 8e-4).at(0);
  EXPECT_LT(std::min(std::abs(values[0] - mu), std::abs(values[1] - mu)), 1e-13);
}

TEST(ModalAnswers, FromAStateAreTheFreeVibration) {
  for (const double ratio : {0.0, 0.05, 0.7}) {
    const Process p = damped(ratio);
    const ModalAnswers found = answers_of(p);
    EXPECT_LT((found.e - free_answer(p, kPiece_s)).norm(), 1e-12) << ratio;
    for (Index i = 0; i < kAnswerNodes; ++i) {
      const double t_s = kPiece_s * GaussNodes::of(kAnswerNodes).node[i];
      EXPECT_LT((found.phi.row(i) - free_answer(p, t_s).row(0)).norm(), 1e-11) << ratio;
      // q̇ = ω·(v/ω).
      EXPECT_LT((found.phi_rate.row(i) / kFree_rad_s - free_answer(p, t_s).row(1)).norm(), 1e-9);
    }
  }
}

// A force F that sets in on an undamped mode moves it by F/k·(1 − cos ωt).
TEST(ModalAnswers, ToASuddenForceAreTheStepResponse) {
  const ModalAnswers found = answers_of(damped(0.0));
  const double still_mm = 7.0 / (1e-3 * 0.03993 * kFree_rad_s * kFree_rad_s);  // 7 N over k
  const Eigen::VectorXd force = Eigen::VectorXd::Constant(kAnswerNodes, 7.0);
  const Eigen::VectorXd x = found.k * force;
  const Eigen::VectorXd rate = found.k_rate * force;
  for (Index i = 0; i < kAnswerNodes; ++i) {
    const double turned = kFree_rad_s * kPiece_s * GaussNodes::of(kAnswerNodes).node[i];
    EXPECT_NEAR(x[i], still_mm * (1.0 - std::cos(turned)), 1e-11 * still_mm);
    EXPECT_NEAR(rate[i], still_mm * kFree_rad_s * std::sin(turned), 1e-9 * still_mm * kFree_rad_s);
  }
  const Eigen::VectorXd end = found.r * force;
  EXPECT_NEAR(end[0], still_mm * (1.0 - std::cos(kFree_rad_s * kPiece_s)), 1e-12 * still_mm);
  EXPECT_NEAR(end[1], still_mm * std::sin(kFree_rad_s * kPiece_s), 1e-12 * still_mm);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
