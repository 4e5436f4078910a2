// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// make() sets the length of the period, plan() in delay_cycle_plan.cpp builds the matrices, and
// set_depth() the inverses. advance() then walks the pieces of one pass: right side from the modes'
// state and the delayed displacements, one small solve, new displacements in place of the old ones.
// retreat() is its transpose; growth_course needs single rows of the map, and with the transpose
// the map itself is never formed.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::outcome::refuse;
using kernel::units::kTurn;

// A period of q passes costs q matrix products and keeps q sets of matrices, so both are bounded:
// beyond them an RVF has no principal period worth the memory.
constexpr std::size_t kMostPasses = 4096;
constexpr std::size_t kMostLawPeriods = 64;

}  // namespace

kernel::outcome::Result<DelayCycle> DelayCycle::make(const Process& process, const Config& config) {
  DelayCycle out;
  out.process_ = process;
  out.components_ = directions(process);
  out.plain_ = process.even_pitch() && process.cut.process_damping_n_mm == 0.0;
  const bool even = process.even_pitch();
  // With even pitch all teeth see the same delay, so one tooth pitch is a period; with uneven pitch
  // the cut repeats only after a whole revolution.
  out.pass_rad_ = even ? kTurn / static_cast<double>(process.tool.teeth) : kTurn;
  const auto whole = [&out](double angle_rad) {
    return std::max(1.0, std::round(angle_rad / out.pass_rad_)) * out.pass_rad_;
  };
  // The speed that a machine really follows may have a period of any length. Stretching it to whole
  // passes changes its timing by at most half a pass; with a remainder there would be no principal
  // period.
  const SpeedProfile speed =
      config.course.empty()
          ? SpeedProfile(config.speed_rev_s, config.modulation)
          : SpeedProfile(config.course, whole(SpeedProfile::angle_rad(config.course)));
  if (!speed.constant()) {
    // The principal period is the least common multiple of law and tooth pass: r law periods that
    // make a whole number of passes, to within rounding.
    // q may be a fraction: RVF = 0.3 with two teeth gives q = 6⅔, and three law periods make 20
    // passes.
    const double q = speed.period_rad() / out.pass_rad_;
    out.passes_ = 0;
    for (std::size_t r = 1; r <= kMostLawPeriods && out.passes_ == 0; ++r) {
      const double passes = std::round(q * static_cast<double>(r));
      if (passes >= 1.0 && std::abs(q * static_cast<double>(r) - passes) < 1e-9 * passes &&
          passes <= static_cast<double>(kMostPasses)) {
        out.passes_ = static_cast<std::size_t>(passes);
        out.law_periods_ = r;
      }
    }
    if (out.passes_ == 0) {
      return refuse(fmt::format("RVF {} has no principal period of {} tooth passes or less",
                                config.modulation.rvf, kMostPasses),
                    "use RVF = teeth/q with whole q, or a ratio of small whole numbers");
    }
  }
  if (auto refusal =
          beyond_reach(process, speed.slowest_rad_s() / kTurn, config.most_depth_mm, out.passes_)) {
    return std::unexpected(std::move(*refusal));
  }
  out.period_s_ = speed.time_s(static_cast<double>(out.passes_) * out.pass_rad_);
  // Last, after all refusals: planning allocates and fills all matrices.
  out.plan(speed, config);
  return out;
}

void DelayCycle::set_depth(double depth_mm) {
  depth_mm_ = depth_mm;
  for (auto& pass : pieces_) {
    for (Piece& piece : pass) {
      if (piece.cuts) {
        // The depth enters linearly: K and Φ stay, only (I + a·HK)⁻¹ is rebuilt for each depth.
        piece.inverse.make(piece.answer, depth_mm);
      }
    }
  }
}

/// Σ_j H_j·x(θ − δ_j) at the nodes.
void DelayCycle::delayed(const Piece& piece, const Eigen::Ref<Eigen::VectorXd>& state,
                         Eigen::Ref<Eigen::VectorXd> out) const {
  const Index n = piece.nodes;
  out.setZero();
  // Pieces that do not cut have no slot. A cutting tooth reads where the previous tooth cut, so a
  // read from such a piece has H = 0.
  for (const Delayed& term : piece.delayed) {
    for (Index i = 0; i < n; ++i) {
      const Read& read = term.read[static_cast<std::size_t>(i)];
      const Eigen::Matrix2d& h = term.h[static_cast<std::size_t>(i)];
      const Piece& from = pieces_[0][read.piece];
      if (from.slot < 0) {
        continue;
      }
      for (Index b = 0; b < components_; ++b) {
        const Index first = b * from.nodes;
        double x = 0.0;
        if (read.row.size() == 0) {
          x = state[from.slot + first + read.node];
        } else {
          x = read.row * state.segment(from.slot + first, from.nodes);
        }
        for (Index c = 0; c < components_; ++c) {
          out[c * n + i] += h(c, b) * x;
        }
      }
    }
  }
}

void DelayCycle::advance(std::size_t pass, Eigen::Ref<Eigen::VectorXd> state) {
  // A piece's values replace those of the last pass as soon as it is passed: no delay is longer
  // than a pass.
  modal_ = state.head(modal_size());
  for (Piece& piece : pieces_[pass]) {
    if (!piece.cuts) {
      piece.x.noalias() = piece.phi * modal_;
      modal_ = piece.e * modal_;
      continue;
    }
    const Index size = piece.nodes * components_;
    auto before = state.segment(piece.slot, size);
    const auto solve = [&] {
      solved_.resize(size);
      piece.inverse.apply({right_.data(), static_cast<std::size_t>(size)},
                          {solved_.data(), static_cast<std::size_t>(size)});
    };
    right_.resize(size);
    // Both ways solve the same equations; they differ in the unknown. With one delay the
    // displacement itself is cheapest; with several delays or with velocity terms only the force is
    // common to all.
    if (plain_) {
      // y = x − x_delayed satisfies (I + a·KH)·y = Φ·s − x_delayed.
      right_ = -before;
      right_.noalias() += piece.phi * modal_;
      solve();
      piece.x = before + solved_;
      modal_ = piece.e * modal_;
      // F = −a·H·y on the tool.
      modal_.noalias() -= piece.rh * (depth_mm_ * solved_);
    } else {
      delayed(piece, state, right_);
      // Here the unknown is F/a: (I + a·(HK + PK̇))·F/a = Σ H·x_delayed − (HΦ + PΦ̇)·s.
      right_.noalias() -= piece.hphi * modal_;
      solve();
      solved_ *= depth_mm_;
      piece.x.noalias() = piece.phi * modal_;
      piece.x.noalias() += piece.k * solved_;
      modal_ = piece.e * modal_;
      modal_.noalias() += piece.r * solved_;
    }
    // In place: no delay is longer than a pass, so the previous pass' values are no longer needed.
    before = piece.x;
  }
  state.head(modal_size()) = modal_;
}

/// Σ_j H_jᵀ·f onto the displacements at θ − δ_j.
void DelayCycle::undelayed(const Piece& piece, const Eigen::VectorXd& forces,
                           Eigen::Ref<Eigen::VectorXd> row) const {
  const Index n = piece.nodes;
  for (const Delayed& term : piece.delayed) {
    for (Index i = 0; i < n; ++i) {
      const Read& read = term.read[static_cast<std::size_t>(i)];
      const Eigen::Matrix2d& h = term.h[static_cast<std::size_t>(i)];
      const Piece& from = pieces_[0][read.piece];
      for (Index b = 0; b < components_ && from.slot >= 0; ++b) {
        double weight = 0.0;
        for (Index c = 0; c < components_; ++c) {
          weight += h(c, b) * forces[c * n + i];
        }
        const Index first = from.slot + b * from.nodes;
        if (read.row.size() == 0) {
          row[first + read.node] += weight;
        } else {
          row.segment(first, from.nodes) += weight * read.row.transpose();
        }
      }
    }
  }
}

/// advance() backwards, each line of it transposed.
void DelayCycle::retreat(std::size_t pass, Eigen::Ref<Eigen::VectorXd> row) {
  Eigen::VectorXd modal = row.head(modal_size());
  for (std::size_t i = pieces_[pass].size(); i-- > 0;) {
    const Piece& piece = pieces_[pass][i];
    if (!piece.cuts) {
      modal = (piece.e.transpose() * modal).eval();
      continue;
    }
    const Index size = piece.nodes * components_;
    auto slot = row.segment(piece.slot, size);
    const auto solve = [&] {
      solved_.resize(size);
      piece.inverse.apply_transposed({right_.data(), static_cast<std::size_t>(size)},
                                     {solved_.data(), static_cast<std::size_t>(size)});
    };
    // advance() has y = A⁻¹·(Φ·s − x₀), x₁ = x₀ + y, s₁ = E·s − a·RH·y. For weights (c, m) of (x₁,
    // s₁) and t = A⁻ᵀ·(c − a·RHᵀ·m) those of (x₀, s) are c − t and Eᵀ·m + Φᵀ·t.
    if (plain_) {
      right_ = slot;
      right_.noalias() -= piece.rh.transpose() * (depth_mm_ * modal);
      solve();
      modal = (piece.e.transpose() * modal + piece.phi.transpose() * solved_).eval();
      slot -= solved_;
    } else {
      // f = a·A⁻¹·(ΣH·x_d − HΦ·s), x₁ = Φ·s + K·f, s₁ = E·s + R·f, transposed the same way.
      right_ = depth_mm_ * (piece.k.transpose() * slot + piece.r.transpose() * modal);
      solve();
      modal = (piece.e.transpose() * modal + piece.phi.transpose() * slot -
               piece.hphi.transpose() * solved_)
                  .eval();
      // advance() overwrote these displacements, so nothing before this piece depends on them
      // except through `delayed`, which undelayed() adds back.
      slot.setZero();
      undelayed(piece, solved_, row);
    }
  }
  row.head(modal_size()) = modal;
}

// A Ref is a view, cheap to pass on.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void DelayCycle::apply(Eigen::Ref<Eigen::VectorXd> state) {
  for (std::size_t p = 0; p < passes_; ++p) {
    advance(p, state);
  }
}

std::vector<DelayCycle::Sample> DelayCycle::last_pass(std::size_t pass) const {
  std::vector<Sample> out;
  double t = 0.0;
  for (std::size_t p = 0; p < pass; ++p) {
    for (const Piece& piece : pieces_[p]) {
      t += GaussNodes::of(piece.nodes).weight.dot(piece.sigma_s);
    }
  }
  for (const Piece& piece : pieces_[pass]) {
    const GaussNodes& gauss = GaussNodes::of(piece.nodes);
    // Time since the piece's start: ∫dθ/Ω to each node.
    const Eigen::VectorXd since = gauss.integral * piece.sigma_s;
    for (Index i = 0; i < piece.nodes; ++i) {
      // The first n numbers of a piece are along x; those along y follow.
      out.push_back({t + since[i], gauss.weight[i] * piece.sigma_s[i], piece.x[i]});
    }
    t += gauss.weight.dot(piece.sigma_s);
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
