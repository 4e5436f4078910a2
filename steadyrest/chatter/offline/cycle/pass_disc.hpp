// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/chatter/offline/cycle/pass_matrix.hpp>

/// The matrix of the tooth pass over a disc of z, as power series about its centre.
///
/// Symbols, all of PassMatrix: μ the multiplier of a tooth pass, ξ = 1/μ, a the depth of cut (mm),
/// z = a·(1 − ξ) (mm), M(z) the matrix of the pass, g(ξ) = det(I − ξ·M(z)), whose zeros are sought.
///
/// g needs ξ and some functions of z: the trace of M, or its entries (PassMatrix::functions). They
/// are entire in z and real on the real axis, so their values at n/2 points of a half circle give n
/// coefficients of Σ f_k·u^k, u = (z − centre)/radius. One disc serves all ξ of a circle and many
/// depths a, and g costs n multiplications instead of the product of all pieces. Over the disc the
/// series reproduces PassMatrix to 1e-12 of the largest value on its rim.
namespace steadyrest::chatter::offline {

class PassDisc {
 public:
  using Complex = PassMatrix::Complex;
  using Lanes = PassMatrix::Lanes;

  /// Empty where the values on the rim are so large, or so many terms are needed, that PassMatrix
  /// itself is the better choice. `terms`: a guess of how many are needed. The disc must lie where
  /// `pass` is valid; `pass` must outlive this.
  [[nodiscard]] static std::optional<PassDisc> make(const PassMatrix& pass, double center_mm,
                                                    double radius_mm, std::size_t terms);

  /// Whether all z with |z − a| ≤ `reach_mm` are within the disc.
  [[nodiscard]] bool holds(double depth_mm, double reach_mm) const noexcept;
  [[nodiscard]] std::size_t terms() const noexcept { return terms_; }

  /// g at each ξ of `xi`. Every z = a·(1 − ξ) must lie within the disc, and the number of ξ must be
  /// a multiple of PassMatrix::kLanes.
  void g(std::span<const Complex> xi, double depth_mm, std::span<Complex> out) const;

 private:
  PassDisc(const PassMatrix& pass, double center_mm, double radius_mm)
      : pass_(&pass), center_mm_(center_mm), radius_mm_(radius_mm) {}
  struct Rim {
    std::size_t points = 0;
    std::vector<Complex> value;  ///< of each function in turn, `points` apart
    std::vector<Complex> back;   ///< e^(−iφ) of each point
    double largest = 0.0;        ///< of the values
  };
  [[nodiscard]] bool sample(std::size_t terms);
  [[nodiscard]] Rim rim(std::size_t terms) const;
  void transform(Rim& rim, std::size_t terms);
  [[nodiscard]] bool cut_tail(double least);

  const PassMatrix* pass_;
  double center_mm_;
  double radius_mm_;
  std::size_t terms_ = 0;
  std::vector<double> number_;  ///< f_k of each function in turn, `terms_` apart
};

}  // namespace steadyrest::chatter::offline
