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

/// Every t in [0, end_s] at which f changes sign, ascending. None is missed: f·e^(λ_1·t) has the
/// zeros of f, and its derivative is a sum with one exponential less. The derivative's sign
/// changes, found in the same way, divide the range into pieces with at most one sign change of f.
/// Each is found to the last bits of t. A zero that only touches is no change of sign.
[[nodiscard]] std::vector<double> sign_changes(Exponentials f, double end_s);

/// The turning points of f, ascending.
[[nodiscard]] std::vector<double> extremes_of(const Exponentials& f, double end_s);

}  // namespace steadyrest::thermal::offline
