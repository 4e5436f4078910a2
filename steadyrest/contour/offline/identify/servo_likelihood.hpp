// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/contour/offline/identify/servo_law.hpp>
#include <steadyrest/contour/offline/identify/servo_runs.hpp>

namespace steadyrest::contour::offline {

/// A law's numbers that a fit may free.
enum class Free : std::size_t { gain, forward, lag, second, delay, mode, damping, weight, lost };
inline constexpr std::size_t kFree = 9;

/// Which numbers are free; the error at rest always is.
struct ServoForm {
  bool free[kFree] = {true, false, false, false, false, false, false, false, false};

  [[nodiscard]] bool has(Free one) const { return free[static_cast<std::size_t>(one)]; }
  ServoForm with(std::initializer_list<Free> these, bool on = true) const {
    ServoForm out = *this;
    for (const Free one : these) {
      out.free[static_cast<std::size_t>(one)] = on;
    }
    return out;
  }
  [[nodiscard]] std::size_t count() const;
};

/// One axis's record as the likelihood wants it.
struct ServoProblem {
  std::vector<std::vector<double>> command;  ///< by unbroken run
  std::vector<Eigen::VectorXd> actual;
  std::vector<std::vector<char>> used;  ///< in motion, and the delay's reach inside the run
  double period_s = 0.0;
  double floor = 1e-8;      ///< RMS that no law explains
  double dispersion = 1.0;  ///< so many residuals hang together; they count for one
};

inline constexpr double kMostDelay_s = 0.03;

[[nodiscard]] ServoProblem problem_of(const ServoLog& log, const std::vector<ServoRun>& runs,
                                      const std::vector<ServoRun>& moving, double period_s,
                                      double floor);

inline constexpr std::size_t kFittedSamples = 40'000;  ///< more tell no more

/// The record's first samples in use.
[[nodiscard]] ServoProblem first_of(const ServoProblem& problem, std::size_t most);

/// Time by which the axis falls behind at constant speed.
[[nodiscard]] double behind_s(const ServoProblem& problem);

struct ServoFitted {
  ServoLaw law;
  ServoForm form;
  std::vector<double> colour;  ///< r[n] = Σ aᵢ·r[n − i] + white noise
  double square = 0.0;         ///< sum of the squares of the white residuals
  std::size_t samples = 0;
  Eigen::MatrixXd variance;  ///< of the free numbers in order, then the error at rest

  double dispersion = 1.0;  ///< mean of the variances by batches over those by the likelihood
  /// −2·ln of the likelihood over the problem's dispersion, and 6 for each number: what a record
  /// supports has the smallest.
  double badness = 0.0;
  /// Standard deviation; 0 where it is not free.
  [[nodiscard]] double sd(Free one) const;
};

/// Maximum likelihood by Gauss–Newton on the free simulation's error, each run's initial state
/// projected out. Residuals are white behind the filter `colour`.
[[nodiscard]] ServoFitted fit_law(const ServoProblem& problem, const ServoLaw& start,
                                  const ServoForm& form, const std::vector<double>& colour,
                                  int most_rounds = 40);

/// The colour of what a law leaves, of the order that the record supports; at most 8.
[[nodiscard]] std::vector<double> colour_of(const ServoProblem& problem, const ServoLaw& law);

/// Variances, the larger of those by the likelihood and by sums over batches longer than 5/k.
void put_variance(const ServoProblem& problem, ServoFitted& fitted);

/// Actual less simulated position of each run, its initial state removed.
[[nodiscard]] std::vector<Eigen::VectorXd> residuals(const ServoProblem& problem,
                                                     const ServoLaw& law);

/// By how much a mode of this frequency would lower the squares, the other numbers free to move.
[[nodiscard]] double mode_gain(const ServoProblem& problem, const ServoFitted& fitted,
                               double rad_s);

}  // namespace steadyrest::contour::offline
