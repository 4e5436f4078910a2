// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace steadyrest::thermal::offline {

/// f(t) = Σ a_k·e^(−λ_k·t), λ ≥ 0 (0: a constant).
struct Exponential {
  double amplitude = 0.0;
  double rate_1_s = 0.0;
};
using Exponentials = std::vector<Exponential>;

[[nodiscard]] double value(const Exponentials& f, double time_s) noexcept;

/// Every t in [0, end_s] at which f changes its sign, rising. None is missed: f·e^(λ_1·t) has the
/// zeros of f, and its derivative is a sum of one exponential less, so its own sign changes, found
/// in the same way, part the range into pieces on which f changes sign once at most. Each is found
/// to the last bits of t. A zero that only touches is no change of sign.
[[nodiscard]] std::vector<double> sign_changes(Exponentials f, double end_s);

/// Where f turns, rising.
[[nodiscard]] std::vector<double> extremes_of(const Exponentials& f, double end_s);

}  // namespace steadyrest::thermal::offline
