// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// One mode under delays that are prescribed over time, spectrally accurate:
///   ẍ + 2ζω·ẋ + ω²·x = Σ_j κ_j·(x(t − τ_j(t)) − x(t)),  τ_j of period T.
///
/// For laws that give the delay, not the speed (turning with the delay modulated as a sine, two
/// cutters), where the spindle angle does not help. T is divided into even pieces shorter than
/// every delay; in each the equation is collocated at Gauss–Legendre nodes, and delayed values come
/// from the polynomials of earlier pieces. The delays must be smooth; the error then falls
/// exponentially with the nodes, to 1e-10 at the default. The state may have any unit.
namespace steadyrest::chatter::offline {

class DelayLaw {
 public:
  struct Term {
    double stiffness_1_s2 = 0.0;            ///< κ, stiffness over mass
    std::function<double(double)> delay_s;  ///< τ(t), > 0, of period T
  };
  struct Config {
    double natural_rad_s = 1.0;  ///< ω > 0
    double damping_ratio = 0.0;  ///< ζ
    std::vector<Term> terms;
    double period_s = 1.0;  ///< T > 0
    double fineness = 1.0;  ///< number of nodes over the default; for convergence studies
  };

  /// Refuses an ω or T that is not above 0 and a delay that is not above T/10 000.
  static kernel::outcome::Result<DelayLaw> make(const Config& config);

  /// x and ẋ/ω, then x at the nodes of the previous pieces, latest first.
  [[nodiscard]] Eigen::Index state_size() const noexcept { return 2 + history_ * nodes_; }
  /// Over T.
  void apply(Eigen::Ref<Eigen::VectorXd> state) const;
  /// Over T, the largest first.
  [[nodiscard]] Multipliers multipliers(std::size_t wanted = 2, double tolerance = 1e-11) const;

 private:
  struct Read {
    Eigen::Index back = 1;   ///< pieces before the present one
    Eigen::RowVectorXd row;  ///< weights of its nodes, times κ
  };
  DelayLaw() = default;
  void fill_piece(const Config& config, double length_s);

  Eigen::Index nodes_ = 0;
  Eigen::Index history_ = 0;             ///< pieces kept
  std::vector<std::vector<Read>> read_;  ///< [piece][node·terms + term]
  std::size_t terms_ = 0;
  Eigen::MatrixXd phi_;  ///< x at the nodes from the state at the piece's start, n×2
  Eigen::MatrixXd k_;    ///< … from the right side, n×n
  Eigen::Matrix2d e_;    ///< state at its end from that at the start
  Eigen::MatrixXd r_;    ///< … from the right side, 2×n
};

}  // namespace steadyrest::chatter::offline
