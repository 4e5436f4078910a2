// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/core.h>

#include <steadyrest/chatter/offline/cycle/delay_law.hpp>
#include <steadyrest/chatter/offline/cycle/gauss_nodes.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// The method of steps: even pieces shorter than every delay, so that a piece's right side is known
// before it is solved. All pieces then share one set of matrices; only the rows that interpolate
// the delayed values differ. The history is a ring of the last pieces' node values.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::outcome::refuse;

// 24 nodes for 8 rad are 3 per radian, twice DelayCycle's 1.5: good to 1e-10.
constexpr double kLawPiecePhase = 8.0;  ///< of the oscillation in one piece, rad
constexpr double kLawPieceNodes = 24.0;
constexpr int kSamples = 2000;        ///< of a delay over T, for its extremes
constexpr double kMargin = 0.95;      ///< piece over the least delay
constexpr double kLeastDelay = 1e-4;  ///< of T

}  // namespace

kernel::outcome::Result<DelayLaw> DelayLaw::make(const Config& config) {
  if (!(config.natural_rad_s > 0.0) || !(config.period_s > 0.0)) {
    return refuse(fmt::format("frequency {} rad/s, period {} s; allowed: above 0",
                              config.natural_rad_s, config.period_s),
                  "give both above 0");
  }
  double least = config.period_s;
  double most = 0.0;
  // ω² + Σ|κ| bounds the fastest oscillation with all delayed terms in phase.
  double square = config.natural_rad_s * config.natural_rad_s;
  for (const Term& term : config.terms) {
    for (int i = 0; i < kSamples; ++i) {
      const double delay = term.delay_s(config.period_s * i / kSamples);
      least = std::min(least, delay);
      most = std::max(most, delay);
    }
    square += std::abs(term.stiffness_1_s2);
  }
  if (!(least > kLeastDelay * config.period_s) || !std::isfinite(most)) {
    return refuse(
        fmt::format("delay of {} s; allowed: above {} s", least, kLeastDelay * config.period_s),
        "keep the delay above 0 at all times");
  }
  DelayLaw out;
  // A piece shorter than the least delay never reads itself, so each follows from earlier ones
  // without a solve.
  const double pieces = std::ceil(std::max(config.period_s * std::sqrt(square) / kLawPiecePhase,
                                           config.period_s / (kMargin * least)));
  const double length = config.period_s / pieces;
  out.nodes_ =
      std::min(static_cast<Index>(std::ceil(kLawPieceNodes * config.fineness)), GaussNodes::kMost);
  // A delay may exceed the period; only samples of its extremes are known, hence the margin.
  out.history_ = static_cast<Index>(std::ceil(1.001 * most / length)) + 1;
  out.terms_ = config.terms.size();
  out.fill_piece(config, length);
  const GaussNodes& gauss = GaussNodes::of(out.nodes_);
  for (double p = 0.0; p < pieces; p += 1.0) {
    auto& reads = out.read_.emplace_back();
    for (Index i = 0; i < out.nodes_; ++i) {
      for (const Term& term : config.terms) {
        const double at = (p + gauss.node[i]) * length;
        const double before = gauss.node[i] - term.delay_s(at) / length;  // in pieces from p
        // At least one piece back, however a delay just above a piece is rounded.
        const double back = std::max(1.0, -std::floor(before));
        reads.push_back(
            {static_cast<Index>(back), term.stiffness_1_s2 * gauss.interpolation(before + back)});
      }
    }
  }
  return out;
}

/// [I + 2ζω·S + w²·S²]·v = v₀ − w²·q₀·S1 + S·f with w² = ω² + Σκ, as for the modes of DelayCycle.
void DelayLaw::fill_piece(const Config& config, double length_s) {
  const GaussNodes& gauss = GaussNodes::of(nodes_);
  const double wn = config.natural_rad_s;
  const double d = 2.0 * config.damping_ratio * wn;
  // −κ·x(t) on the right side is stiffness; only κ·x(t − τ) stays a force.
  double w2 = wn * wn;
  for (const Term& term : config.terms) {
    w2 += term.stiffness_1_s2;
  }
  // As modal_answers() does for one mode, at an even pace in time.
  const Eigen::MatrixXd s = length_s * gauss.integral;
  const Eigen::RowVectorXd end = length_s * gauss.weight.transpose();
  Eigen::MatrixXd a = d * s + w2 * length_s * length_s * gauss.integral2;
  a.diagonal().array() += 1.0;
  Eigen::MatrixXd right(nodes_, nodes_ + 2);
  right.col(0) = -w2 * s.rowwise().sum();
  right.col(1).setConstant(wn);
  right.rightCols(nodes_) = s;
  const Eigen::MatrixXd v = a.partialPivLu().solve(right);
  Eigen::MatrixXd q = s * v;
  q.col(0).array() += 1.0;
  const Eigen::RowVectorXd q_end = end * v;
  Eigen::RowVectorXd v_end = -w2 * (end * q) - d * q_end;
  v_end.tail(nodes_) += end;
  phi_ = q.leftCols(2);
  k_ = q.rightCols(nodes_);
  e_.row(0) = q_end.head(2);
  e_.row(1) = v_end.head(2) / wn;
  e_.diagonal().array() += 1.0;
  r_.resize(2, nodes_);
  r_.row(0) = q_end.tail(nodes_);
  r_.row(1) = v_end.tail(nodes_) / wn;
}

void DelayLaw::apply(Eigen::Ref<Eigen::VectorXd> state) const {
  Eigen::Vector2d modal = state.head(2);
  Eigen::MatrixXd ring(nodes_, history_);  // column (p − back) modulo history
  const auto column = [&](Index piece) { return ((piece % history_) + history_) % history_; };
  for (Index back = 1; back <= history_; ++back) {
    ring.col(column(-back)) = state.segment(2 + (back - 1) * nodes_, nodes_);
  }
  Eigen::VectorXd f(nodes_);
  for (std::size_t p = 0; p < read_.size(); ++p) {
    const auto& reads = read_[p];
    for (Index i = 0; i < nodes_; ++i) {
      f[i] = 0.0;
      for (std::size_t j = 0; j < terms_; ++j) {
        const Read& read = reads[static_cast<std::size_t>(i) * terms_ + j];
        f[i] += read.row * ring.col(column(static_cast<Index>(p) - read.back));
      }
    }
    ring.col(column(static_cast<Index>(p))) = phi_ * modal + k_ * f;
    modal = (e_ * modal + r_ * f).eval();
  }
  const auto pieces = static_cast<Index>(read_.size());
  state.head(2) = modal;
  for (Index back = 1; back <= history_; ++back) {
    state.segment(2 + (back - 1) * nodes_, nodes_) = ring.col(column(pieces - back));
  }
}

Multipliers DelayLaw::multipliers(std::size_t wanted, double tolerance) const {
  return multipliers_of([this](const auto& state) { apply(state); }, state_size(), wanted,
                        tolerance);
}

}  // namespace steadyrest::chatter::offline
