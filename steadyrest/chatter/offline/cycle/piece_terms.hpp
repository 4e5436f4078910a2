// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>

/// The matrices of the pieces of a stretch of the cut at constant speed, as power series in z.
///
/// Within a piece x = Φ·s + K·F at the nodes and F = −z·H·x, so that F = Σ F_k·z^k with F_{k+1} =
/// −H·x_k, x_0 = Φ·s, x_k = K·F_k. HK is a Volterra operator: the terms fall as 1/(2k)!. The state
/// at the end is E·s + R·F.
namespace steadyrest::chatter::offline {

inline constexpr double kLeastTerm = 1e-14;  ///< of a series in z: the first to be omitted

/// A part of the pass where only the forces change, divided into even pieces.
struct Stretch {
  const Process& process;
  const CuttingCoefficients& coefficients;
  double speed_rev_s;
  double begin_rad;  ///< of the pass
  double length_rad;
  std::size_t pieces;
};

class PieceTerms {
 public:
  /// Terms for |z| ≤ `most_z_mm`.
  PieceTerms(const Stretch& stretch, std::size_t order, double most_z_mm);

  [[nodiscard]] std::size_t count() const noexcept { return term_.size(); }
  /// Number `i`, by rows, of a piece's matrix at z^k.
  [[nodiscard]] double at(std::size_t k, std::size_t piece, std::size_t i) const noexcept {
    return term_[k][i / order_ * stride_ + piece * order_ + i % order_];
  }

 private:
  std::size_t order_;
  std::size_t stride_;
  std::vector<std::vector<double>> term_;  ///< rows, in each all pieces
};

}  // namespace steadyrest::chatter::offline
