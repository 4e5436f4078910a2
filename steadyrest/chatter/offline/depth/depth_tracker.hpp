// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/pass_disc.hpp>
#include <steadyrest/chatter/offline/cycle/pass_matrix.hpp>

/// The dominant multiplier at one speed for depths that rise: constant speed, even pitch, no
/// process damping.
///
/// Zeros ξ = 1/μ of PassMatrix::g are followed from depth to depth by Halley's steps. That none is
/// nearer to 0 than the nearest one followed is counted by the argument principle on a circle just
/// inside of it; where one is, Arnoldi's method on the DelayCycle finds it. So a new lobe cannot be
/// missed, and an ordinary point costs some 40 evaluations of g, four at a time.
/// Heavy damping with many waves between two teeth crowds the multipliers; with ζ ≥ 0.75 and 30 to
/// 50 waves the border comes out up to 1.2 % too deep (turning, against the closed form).
namespace steadyrest::chatter::offline {

class DepthTracker {
 public:
  using Complex = std::complex<double>;

  /// The process must be PassMatrix::simple(); `most_depth_mm` > 0.
  DepthTracker(Process process, double speed_rev_s, double most_depth_mm);

  /// Dominant multiplier at a depth; quickest where it is not below the last one. One of a pair:
  /// Im ≥ 0.
  [[nodiscard]] Complex dominant(double depth_mm);

  /// Depth of the lowest crossing of |μ| = 1 to 1e-10 of it, found between `most_depth_mm`/steps
  /// apart; empty: stable throughout.
  [[nodiscard]] std::optional<double> border_mm(std::size_t steps);

  /// How often Arnoldi's method was needed.
  [[nodiscard]] std::size_t helped() const noexcept { return helped_; }

 private:
  static constexpr double kMostXi = 3.0;  ///< smaller multipliers are left to Arnoldi's method

  struct Root {
    Complex xi;
    Complex slope;  ///< dξ/da
  };
  [[nodiscard]] bool follow(Root& root, double from_mm, double to_mm);
  /// Another zero than those in `but`.
  [[nodiscard]] std::optional<Complex> refine(Complex start, double depth_mm,
                                              std::span<const Complex> but = {});
  [[nodiscard]] std::optional<int> zeros_within(double radius, double depth_mm);
  /// For |z| ≤ `z_mm` at this depth.
  [[nodiscard]] const PassMatrix& pass(double z_mm, double depth_mm);
  /// Makes the disc for |ξ| ≤ `size` at this depth and at what comes next.
  void aim(double size, double depth_mm);
  /// A multiple of PassMatrix::kLanes of them.
  void g(std::span<const Complex> xi, double depth_mm, std::span<Complex> out);
  void seed(double depth_mm);
  [[nodiscard]] bool verified(double depth_mm);
  [[nodiscard]] bool search(double depth_mm);
  void sort();
  [[nodiscard]] Complex by_arnoldi(double depth_mm);

  Process process_;
  double speed_rev_s_;
  double most_depth_mm_;
  bool each_depth_;           ///< has its own matrices: helical teeth
  double made_for_mm_ = 0.0;  ///< then they are those of this depth
  static constexpr std::size_t kLevels = 4;
  /// For |z| up to the greatest over 1, 3, 9 …: the fewer, the quicker. Made when first used.
  std::array<std::unique_ptr<PassMatrix>, kLevels> pass_;
  std::optional<PassDisc> disc_;
  std::size_t terms_ = 0;  ///< of the last disc
  std::unique_ptr<DelayCycle> cycle_;
  double free_log_radius_ = -1e300;  ///< ln|μ| at depth 0
  std::vector<Complex> half_circle_;
  std::vector<Complex> on_circle_, values_;  ///< of one count
  std::vector<Root> roots_;                  ///< Im ξ ≥ 0, the smallest |ξ| first
  double depth_mm_ = 0.0;
  std::size_t helped_ = 0;
};

}  // namespace steadyrest::chatter::offline
