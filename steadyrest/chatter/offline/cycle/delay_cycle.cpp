// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;

constexpr double kTurn = 2.0 * std::numbers::pi;
// A period of q passes costs q matrix products and keeps q sets of matrices, so both are bounded:
// beyond them an RVF has no principal period worth the memory.
constexpr std::size_t kMostPasses = 4096;
constexpr std::size_t kMostLawPeriods = 64;
/// Angle of the fastest oscillation in one piece, and nodes for it: 1e-9 in the multipliers.
constexpr double kPiecePhase = 14.0;
constexpr double kNodesPerRadian = 0.75;
constexpr double kNodesAtLeast = 11.0;

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
  const SpeedProfile speed =
      config.course.empty()
          ? SpeedProfile(config.speed_rev_s, config.modulation)
          : SpeedProfile(config.course, whole(SpeedProfile::angle_rad(config.course)));
  if (!speed.constant()) {
    // The principal period is the least common multiple of law and tooth pass: r law periods that
    // make a whole number of passes, to within rounding.
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
      return std::unexpected(
          Refusal{Kind::bad_input, "", 0,
                  fmt::format("RVF {} has no principal period of {} tooth passes or less",
                              config.modulation.rvf, kMostPasses),
                  "use RVF = teeth/q with whole q, or a ratio of small whole numbers"});
    }
  }
  if (auto refusal =
          beyond_reach(process, speed.slowest_rad_s() / kTurn, config.most_depth_mm, out.passes_)) {
    return std::unexpected(std::move(*refusal));
  }
  out.period_s_ = speed.time_s(static_cast<double>(out.passes_) * out.pass_rad_);
  // Last, after every refusal: planning allocates and fills all matrices.
  out.plan(speed, config);
  return out;
}

void DelayCycle::plan(const SpeedProfile& speed, const Config& config) {
  // Sized for the greatest depth: the cutting stiffness a·K raises the frequencies that the nodes
  // must resolve, so smaller depths are resolved all the more.
  depth_mm_ = config.most_depth_mm;
  const CuttingCoefficients coefficients(process_, depth_mm_);
  // At the slowest speed a given angle lasts longest and holds the most waves; pieces that do there
  // do everywhere.
  const double slowest_rev_s = speed.slowest_rad_s() / kTurn;
  const double fastest = fastest_rad_s(process_, config.most_depth_mm, slowest_rev_s);
  std::vector<Piece> pass;
  std::vector<double> of_speed;
  for (std::size_t r = 0; r < law_periods_; ++r) {
    for (const double c : speed.corners_rad()) {
      of_speed.push_back(c + static_cast<double>(r) * speed.period_rad());
    }
  }
  const std::vector<double> corners = corners_of_pass(process_, coefficients, pass_rad_, of_speed);
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    // Decided in the middle: at the corners themselves a tooth is just entering or leaving.
    const bool cuts = cuts_at(coefficients, pass_rad_, 0.5 * (corners[i] + corners[i + 1]));
    const double length = corners[i + 1] - corners[i];
    const double phase = length / (kTurn * slowest_rev_s) * fastest;
    const double parts = std::max(1.0, std::ceil(phase / kPiecePhase));
    const double nodes = config.fineness * (kNodesAtLeast + kNodesPerRadian * phase / parts);
    for (double k = 0.0; k < parts; k += 1.0) {
      Piece piece;
      piece.begin_rad = corners[i] + length * k / parts;
      piece.end_rad = corners[i] + length * (k + 1.0) / parts;
      piece.nodes = std::min(static_cast<Index>(std::ceil(nodes)), GaussNodes::kMost);
      piece.cuts = cuts;
      pass.push_back(std::move(piece));
    }
  }
  state_size_ = modal_size();
  for (Piece& piece : pass) {
    if (piece.cuts) {
      // Only cutting pieces are read by the next tooth, so only their displacements belong to the
      // state.
      piece.slot = state_size_;
      state_size_ += piece.nodes * components_;
    }
  }
  pieces_.assign(passes_, pass);
  for (std::size_t p = 0; p < passes_; ++p) {
    for (std::size_t i = 0; i < pass.size(); ++i) {
      Piece& piece = pieces_[p][i];
      const GaussNodes& gauss = GaussNodes::of(piece.nodes);
      const double length = piece.end_rad - piece.begin_rad;
      piece.sigma_s.resize(piece.nodes);
      for (Index n = 0; n < piece.nodes; ++n) {
        const double angle =
            static_cast<double>(p) * pass_rad_ + piece.begin_rad + length * gauss.node[n];
        // dt = dθ/Ω: the speed enters nowhere else, which is why θ is the independent variable.
        piece.sigma_s[n] = length / speed.speed_rad_s(angle);
      }
      static_cast<ModalAnswers&>(piece) = modal_answers(process_, gauss, piece.sigma_s, components_,
                                                        process_.cut.process_damping_n_mm > 0.0);
      if (piece.cuts && plain_) {
        fill_plain(piece);
      } else if (piece.cuts) {
        fill_reads(i + p * pass.size());
      }
    }
  }
}

/// KH and RH of all teeth; what else there is of K is not needed.
void DelayCycle::fill_plain(Piece& piece) const {
  const GaussNodes& gauss = GaussNodes::of(piece.nodes);
  const CuttingCoefficients coefficients(process_, depth_mm_);
  const Index n = piece.nodes;
  piece.answer.setZero(piece.k.rows(), piece.k.cols());
  piece.rh.setZero(piece.r.rows(), piece.r.cols());
  for (Index i = 0; i < n; ++i) {
    const double angle = piece.begin_rad + (piece.end_rad - piece.begin_rad) * gauss.node[i];
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
    for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
      h += coefficients.stiffness(j, angle);
    }
    for (Index c = 0; c < components_; ++c) {
      for (Index b = 0; b < components_; ++b) {
        piece.answer.col(b * n + i) += h(c, b) * piece.k.col(c * n + i);
        piece.rh.col(b * n + i) += h(c, b) * piece.r.col(c * n + i);
      }
    }
  }
  // With one delay and no process damping x − x_delayed is solved for directly; the forces, and
  // with them K and R, are not needed.
  piece.k.resize(0, 0);
  piece.r.resize(0, 0);
}

/// H and P at the nodes, and where each tooth's delayed displacement is read.
void DelayCycle::fill_reads(std::size_t index) {
  const std::size_t p = index / pieces_[0].size();
  const std::size_t i = index % pieces_[0].size();
  Piece& piece = pieces_[p][i];
  const GaussNodes& gauss = GaussNodes::of(piece.nodes);
  const CuttingCoefficients coefficients(process_, depth_mm_);
  const bool even = process_.even_pitch();
  piece.delayed.clear();
  // With even pitch all teeth share one delay, so their stiffnesses add up to one term.
  const std::size_t terms = even ? 1 : coefficients.teeth();
  for (std::size_t j = 0; j < terms; ++j) {
    Delayed delayed;
    for (Index n = 0; n < piece.nodes; ++n) {
      const double angle = piece.begin_rad + (piece.end_rad - piece.begin_rad) * gauss.node[n];
      Eigen::Matrix2d h = coefficients.stiffness(j, angle);
      for (std::size_t other = 1; even && other < coefficients.teeth(); ++other) {
        h += coefficients.stiffness(other, angle);
      }
      delayed.h.push_back(h);
      // Even pitch: the delayed point is the same node one pass before. Uneven: it falls between
      // nodes and is interpolated.
      delayed.read.push_back(even ? Read{i, true, n, {}} : read_at(angle - process_.pitch_rad(j)));
    }
    const bool answers = std::ranges::any_of(
        delayed.h, [](const Eigen::Matrix2d& h) { return h.cwiseAbs().maxCoeff() > 0.0; });
    if (answers) {
      piece.delayed.push_back(std::move(delayed));
    }
  }
  fill_cut(piece);
}

DelayCycle::Read DelayCycle::read_at(double angle_rad) const {
  const bool before = angle_rad < 0.0;
  // No tooth's pitch exceeds a revolution, so one pass back is always enough.
  const double within = before ? angle_rad + pass_rad_ : angle_rad;
  const auto& pass = pieces_[0];
  std::size_t i = 0;
  while (i + 1 < pass.size() && pass[i].end_rad <= within) {
    ++i;
  }
  const GaussNodes& gauss = GaussNodes::of(pass[i].nodes);
  Read out{i, before, 0, {}};
  out.row =
      gauss.interpolation((within - pass[i].begin_rad) / (pass[i].end_rad - pass[i].begin_rad));
  return out;
}

void DelayCycle::fill_cut(Piece& piece) const {
  const GaussNodes& gauss = GaussNodes::of(piece.nodes);
  const CuttingCoefficients coefficients(process_, depth_mm_);
  const Index n = piece.nodes;
  const bool damped = process_.cut.process_damping_n_mm > 0.0;
  piece.answer.setZero(n * components_, n * components_);
  piece.hphi.setZero(n * components_, piece.phi.cols());
  for (Index i = 0; i < n; ++i) {
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
    for (const Delayed& delayed : piece.delayed) {
      h += delayed.h[static_cast<std::size_t>(i)];
    }
    Eigen::Matrix2d p = Eigen::Matrix2d::Zero();
    if (damped) {
      const double angle = piece.begin_rad + (piece.end_rad - piece.begin_rad) * gauss.node[i];
      for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
        p += coefficients.damping(j, angle);
      }
      // σ is length over Ω, so this is Ω/2π at the node: process damping is C·(a/v)·ẋ and falls
      // with the speed.
      const double rev_s = (piece.end_rad - piece.begin_rad) / piece.sigma_s[i] / kTurn;
      p /= rev_s;
    }
    for (Index c = 0; c < components_; ++c) {
      for (Index b = 0; b < components_; ++b) {
        piece.answer.row(c * n + i) += h(c, b) * piece.k.row(b * n + i);
        piece.hphi.row(c * n + i) += h(c, b) * piece.phi.row(b * n + i);
        if (damped) {
          piece.answer.row(c * n + i) += p(c, b) * piece.k_rate.row(b * n + i);
          piece.hphi.row(c * n + i) += p(c, b) * piece.phi_rate.row(b * n + i);
        }
      }
    }
  }
}

void DelayCycle::set_depth(double depth_mm) {
  depth_mm_ = depth_mm;
  for (auto& pass : pieces_) {
    for (Piece& piece : pass) {
      if (piece.cuts) {
        // The depth enters linearly: K and Φ stay, only (I + a·HK)⁻¹ is made for each depth.
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
  // A piece's values of this pass take the place of the last one's as soon as it is passed: no
  // delay is longer than a pass.
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
    // In place: no delay is longer than a pass, so the values of the pass before are used up now.
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
    if (plain_) {
      right_ = slot;
      right_.noalias() -= piece.rh.transpose() * (depth_mm_ * modal);
      solve();
      modal = (piece.e.transpose() * modal + piece.phi.transpose() * solved_).eval();
      slot -= solved_;
    } else {
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

// A Ref is a view, cheap to hand on.
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
      out.push_back({t + since[i], gauss.weight[i] * piece.sigma_s[i], piece.x[i]});
    }
    t += gauss.weight.dot(piece.sigma_s);
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
