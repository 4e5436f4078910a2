// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/reach.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Divides the period into pieces and builds the matrices of each.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::units::kTurn;

/// Angle of the fastest oscillation in one piece, and nodes for it: 1e-9 in the multipliers.
constexpr double kCyclePiecePhase = 14.0;
// A polynomial at Gauss nodes converges once it has more than π nodes for each wave (Gottlieb and
// Orszag 1977). 0.75 per radian are 4.7 per wave; the constant adds the digits. Longer pieces would
// need fewer nodes in all, but each inverse costs the cube of its nodes.
constexpr double kNodesPerRadian = 0.75;
constexpr double kNodesAtLeast = 11.0;

}  // namespace

/// The pieces of a pass: their borders, their nodes and whether they cut.
std::vector<DelayCycle::Piece> DelayCycle::pieces_of_pass(const SpeedProfile& speed,
                                                          const Config& config) const {
  const CuttingCoefficients coefficients(process_, depth_mm_);
  // At the slowest speed a given angle lasts longest and holds the most waves; pieces sized for it
  // suffice everywhere.
  const double slowest_rev_s = speed.slowest_rad_s() / kTurn;
  const double fastest = fastest_rad_s(process_, depth_mm_, slowest_rev_s);
  // The speed's kinks of every law period fold onto one pass: all passes share their borders, so
  // that a displacement and its delayed twin are at the same node.
  std::vector<double> of_speed;
  for (std::size_t r = 0; r < law_periods_; ++r) {
    for (const double c : speed.corners_rad()) {
      of_speed.push_back(c + static_cast<double>(r) * speed.period_rad());
    }
  }
  const std::vector<double> corners = corners_of_pass(process_, coefficients, pass_rad_, of_speed);
  std::vector<Piece> pass;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    // Decided in the middle: at the corners themselves a tooth is just entering or leaving.
    const bool cuts = cuts_at(coefficients, pass_rad_, 0.5 * (corners[i] + corners[i + 1]));
    const double length = corners[i + 1] - corners[i];
    const double phase = length / (kTurn * slowest_rev_s) * fastest;
    const double parts = std::max(1.0, std::ceil(phase / kCyclePiecePhase));
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
  return pass;
}

void DelayCycle::plan(const SpeedProfile& speed, const Config& config) {
  // Sized for the greatest depth: the cutting stiffness a·K raises the frequencies that the nodes
  // must resolve, so smaller depths are resolved even better.
  depth_mm_ = config.most_depth_mm;
  std::vector<Piece> pass = pieces_of_pass(speed, config);
  state_size_ = modal_size();
  for (Piece& piece : pass) {
    if (piece.cuts) {
      // The next tooth reads only cutting pieces, so only their displacements belong to the state.
      piece.slot = state_size_;
      state_size_ += piece.nodes * components_;
    }
  }
  pieces_.assign(passes_, pass);
  for (std::size_t p = 0; p < passes_; ++p) {
    for (std::size_t i = 0; i < pass.size(); ++i) {
      fill(speed, p, i);
    }
  }
}

/// The matrices of piece `i` of a pass.
void DelayCycle::fill(const SpeedProfile& speed, std::size_t pass, std::size_t i) {
  Piece& piece = pieces_[pass][i];
  const GaussNodes& gauss = GaussNodes::of(piece.nodes);
  const double length = piece.end_rad - piece.begin_rad;
  piece.sigma_s.resize(piece.nodes);
  for (Index n = 0; n < piece.nodes; ++n) {
    const double angle =
        static_cast<double>(pass) * pass_rad_ + piece.begin_rad + length * gauss.node[n];
    // dt = dθ/Ω: the speed enters nowhere else, which is why θ is the independent variable.
    piece.sigma_s[n] = length / speed.speed_rad_s(angle);
  }
  static_cast<ModalAnswers&>(piece) = modal_answers(process_, gauss, piece.sigma_s, components_,
                                                    process_.cut.process_damping_n_mm > 0.0);
  if (piece.cuts && plain_) {
    fill_plain(piece);
  } else if (piece.cuts) {
    fill_reads(pass, i);
  }
}

/// KH and RH of all teeth; nothing else of K is needed.
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
void DelayCycle::fill_reads(std::size_t pass, std::size_t i) {
  Piece& piece = pieces_[pass][i];
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
  // Borders and nodes are the same in all passes, so the first one serves for all.
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
  // H multiplies from the left here, since the unknown is the force; in fill_plain() it is the
  // displacement, and H multiplies from the right.
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

}  // namespace steadyrest::chatter::offline
