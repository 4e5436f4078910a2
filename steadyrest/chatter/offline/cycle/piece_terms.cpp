// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/offline/cycle/columns.hpp>
#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/piece_terms.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// All pieces of a stretch have the same length and speed, so Φ, K, E and R are the same; only H
// differs. Their columns lie side by side in one wide matrix, and each step of the recursion
// F_{k+1} = −H·x_k, x_k = K·F_k is one product for all of them.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::units::kTurn;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A piece turns by at most 5 rad (kPiecePhase in pass_matrix.cpp), which 14 nodes carry to 1e-12.
constexpr Index kNodes = 14;
constexpr std::size_t kMostTerms = 32;

/// One number for each node and direction, column and piece: rows of `stride`.
using Rows = std::vector<double>;

/// Forces, displacements and coefficients of all pieces, row by row the nodes of x, then of y.
class Pieces {
 public:
  Pieces(const Stretch& stretch, std::size_t order, std::size_t stride)
      : directions_(static_cast<std::size_t>(directions(stretch.process))),
        nodes_(directions_ * static_cast<std::size_t>(kNodes)),
        order_(order),
        pieces_(stretch.pieces),
        stride_(stride),
        h_(nodes_ * directions_ * stride),
        y_(nodes_ * stride),
        force_(nodes_ * stride) {
    const GaussNodes& gauss = GaussNodes::of(kNodes);
    const auto parts = static_cast<double>(pieces_);
    const double length_s = stretch.length_rad / (kTurn * stretch.speed_rev_s) / parts;
    const ModalAnswers answers =
        modal_answers(stretch.process, gauss, Eigen::VectorXd::Constant(kNodes, length_s),
                      static_cast<Index>(directions_), false);
    e_ = answers.e;
    k_ = answers.k;
    r_ = answers.r;
    for (std::size_t p = 0; p < pieces_; ++p) {
      const double begin = stretch.begin_rad + stretch.length_rad * static_cast<double>(p) / parts;
      for (std::size_t n = 0; n < static_cast<std::size_t>(kNodes); ++n) {
        const double angle = begin + stretch.length_rad / parts * gauss.node[static_cast<Index>(n)];
        Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
        for (std::size_t j = 0; j < stretch.coefficients.teeth(); ++j) {
          h += stretch.coefficients.stiffness(j, angle);
        }
        fill(p, n, h, answers.phi);
      }
    }
  }

  [[nodiscard]] Rows first() const {
    Rows out(order_ * stride_);
    for (std::size_t row = 0; row < order_; ++row) {
      for (std::size_t at = 0; at < order_ * pieces_; ++at) {
        // z⁰: nothing is cut, and all pieces of the stretch are equally long.
        out[row * stride_ + at] = e_(static_cast<Index>(row), static_cast<Index>(at % order_));
      }
    }
    return out;
  }

  /// R·F_{k+1} from x_k.
  [[nodiscard]] Rows next() {
    for (std::size_t row = 0; row < nodes_; ++row) {
      const std::size_t node = row % static_cast<std::size_t>(kNodes);
      double* const force = &force_[row * stride_];
      std::fill_n(force, stride_, 0.0);
      for (std::size_t from = 0; from < directions_; ++from) {
        const double* const h = &h_[(row * directions_ + from) * stride_];
        const double* const y = &y_[(from * static_cast<std::size_t>(kNodes) + node) * stride_];
        for (std::size_t i = 0; i < stride_; ++i) {
          // F_{k+1} = −H·x_k.
          force[i] -= h[i] * y[i];
        }
      }
    }
    Rows out(order_ * stride_);
    for (std::size_t row = 0; row < order_; ++row) {
      sum_columns(force_.data(), stride_, nodes_, &r_(static_cast<Index>(row), 0),
                  &out[row * stride_]);
    }
    return out;
  }

  /// x_k = K·F_k.
  void answer_to_forces() {
    for (std::size_t row = 0; row < nodes_; ++row) {
      sum_columns(force_.data(), stride_, nodes_, &k_(static_cast<Index>(row), 0),
                  &y_[row * stride_]);
    }
  }

 private:
  void fill(std::size_t piece, std::size_t node, const Eigen::Matrix2d& h,
            const Eigen::MatrixXd& phi) {
    for (std::size_t q = 0; q < order_; ++q) {
      const std::size_t at = piece * order_ + q;
      for (std::size_t to = 0; to < directions_; ++to) {
        const std::size_t row = to * static_cast<std::size_t>(kNodes) + node;
        y_[row * stride_ + at] = phi(static_cast<Index>(row), static_cast<Index>(q));
        for (std::size_t from = 0; from < directions_; ++from) {
          h_[(row * directions_ + from) * stride_ + at] =
              h(static_cast<Index>(to), static_cast<Index>(from));
        }
      }
    }
  }

  std::size_t directions_;
  std::size_t nodes_;
  std::size_t order_;
  std::size_t pieces_;
  std::size_t stride_;
  Eigen::MatrixXd e_;
  RowMajor k_;
  RowMajor r_;
  Rows h_;  ///< of each row, from each direction in turn
  Rows y_;  ///< x_k
  Rows force_;
};

}  // namespace

PieceTerms::PieceTerms(const Stretch& stretch, std::size_t order, double most_z_mm)
    : order_(order), stride_(filled_up(order * stretch.pieces)) {
  Pieces pieces(stretch, order, stride_);
  term_.push_back(pieces.first());
  // The first term is E, the free vibration; each further one is R·F_k.
  double power = 1.0;
  while (term_.size() < kMostTerms) {
    term_.push_back(pieces.next());
    power *= most_z_mm;
    double largest = 0.0;
    for (const double number : term_.back()) {
      largest = std::max(largest, std::abs(number));
    }
    // At the greatest |z| required; the terms fall as 1/(2k)!, so all later ones are smaller still.
    if (largest * power < kLeastTerm) {
      break;
    }
    pieces.answer_to_forces();
  }
}

}  // namespace steadyrest::chatter::offline
