// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/process/process.hpp>

/// The tooth pass as a small matrix, for even pitch, constant speed and no process damping.
///
/// A Floquet solution has x(t − T) = x(t)/μ, so within it the delay is a factor: the cut is an
/// ordinary periodic equation with the stiffness z·H(θ), z = a·(1 − ξ), ξ = 1/μ, and its 2m×2m
/// matrix M(z) of one pass has μ as an eigenvalue,
///   g(ξ) = det(I − ξ·M(a·(1 − ξ))) = 0.
/// g is entire in ξ; the dominant multiplier is 1/ξ of its smallest zero. M is a product of short
/// pieces, each a power series in z whose terms fall as 1/(2k)!. With straight teeth M depends only
/// on z and serves all depths; with helical teeth it holds for one. Relative error of M: 1e-12 for
/// |z| ≤ `most_z_mm`; invalid beyond.
namespace steadyrest::chatter::offline {

struct Stretch;

class PassMatrix {
 public:
  using Complex = std::complex<double>;
  /// Number of z or ξ at once, at little more than the cost of one.
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<Complex, kLanes>;

  /// Even pitch, no process damping.
  [[nodiscard]] static bool simple(const Process& process) noexcept;

  /// The process must be `simple()`. `depth_mm` matters only for helical teeth.
  PassMatrix(const Process& process, double speed_rev_s, double most_z_mm, double depth_mm);

  /// The number of functions that g needs in addition to ξ: the trace of M where M is 2×2 (its
  /// determinant does not depend on z, by Liouville), else its entries by columns.
  [[nodiscard]] std::size_t functions() const noexcept { return functions_; }
  /// Computes `functions()` values at four z, from `out` on.
  void values(const Lanes& z, Lanes* out) const;
  /// g at four ξ from the values at z = a·(1 − ξ).
  [[nodiscard]] Lanes g_of(const Lanes& xi, const Lanes* value) const;

  [[nodiscard]] Complex g(Complex xi, double depth_mm) const;
  [[nodiscard]] Lanes g_lanes(const Lanes& xi, double depth_mm) const;
  [[nodiscard]] double most_z_mm() const noexcept { return most_z_mm_; }

 private:
  /// M of one piece is Σ term[k]·z^k; the terms by rows from `begin` on.
  struct Series {
    std::size_t begin = 0;
    std::vector<double> reach_mm;  ///< |z| up to which as many terms suffice
  };
  void add_free(const Eigen::MatrixXd& e);
  void add_cutting(const Stretch& stretch);
  [[nodiscard]] Eigen::MatrixXcd matrix(Complex z) const;

  Eigen::Index order_;
  std::size_t functions_;
  double most_z_mm_;
  double determinant_ = 1.0;  ///< of M, the same for all z (Liouville)
  std::vector<Series> series_;
  std::vector<double> number_;
};

}  // namespace steadyrest::chatter::offline
