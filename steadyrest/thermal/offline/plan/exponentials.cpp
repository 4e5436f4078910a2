// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/math/tools/toms748_solve.hpp>

#include <steadyrest/thermal/offline/plan/exponentials.hpp>

namespace steadyrest::thermal::offline {
namespace {

/// Merges terms of the same rate and drops zero terms.
void merge(Exponentials& f) {
  std::ranges::sort(f, {}, &Exponential::rate_1_s);
  Exponentials out;
  for (const Exponential& term : f) {
    if (!out.empty() && out.back().rate_1_s == term.rate_1_s) {
      out.back().amplitude += term.amplitude;
    } else {
      out.push_back(term);
    }
  }
  std::erase_if(out, [](const Exponential& term) { return term.amplitude == 0.0; });
  f = std::move(out);
}

double root_between(const Exponentials& f, double low, double high, double at_low, double at_high) {
  // Algorithm 748 (Alefeld, Potra and Shi 1995) keeps a bracket and converges superlinearly.
  std::uintmax_t most = 200;
  const auto ends = boost::math::tools::toms748_solve(
      [&](double t) { return value(f, t); }, low, high, at_low, at_high,
      boost::math::tools::eps_tolerance<double>(50), most);
  return 0.5 * (ends.first + ends.second);
}

}  // namespace

double value(const Exponentials& f, double time_s) noexcept {
  double sum = 0.0;
  for (const Exponential& term : f) {
    sum +=
        term.rate_1_s == 0.0 ? term.amplitude : term.amplitude * std::exp(-term.rate_1_s * time_s);
  }
  return sum;
}

// Rolle's theorem, recursively: divide f by its slowest term, differentiate, and one term is gone.
// The zeros of the rest divide the range into pieces with at most one sign change of f, which a
// bracketing solver finds.
std::vector<double> sign_changes(Exponentials f, double end_s) {
  merge(f);
  if (f.size() < 2) {
    return {};
  }
  Exponentials derivative;
  for (std::size_t k = 1; k < f.size(); ++k) {
    // Of f·e^(λ₀t): its terms a_k·e^(−(λ_k − λ₀)·t) give (λ₀ − λ_k)·a_k. The common factor e^(λ₀t)
    // changes no sign and is dropped again.
    derivative.push_back({f[k].amplitude * (f[0].rate_1_s - f[k].rate_1_s), f[k].rate_1_s});
  }
  std::vector<double> borders = sign_changes(std::move(derivative), end_s);
  borders.push_back(end_s);
  std::vector<double> out;
  double low = 0.0;
  double at_low = value(f, low);
  for (const double high : borders) {
    const double at_high = value(f, high);
    if ((at_low < 0.0 && at_high > 0.0) || (at_low > 0.0 && at_high < 0.0)) {
      out.push_back(root_between(f, low, high, at_low, at_high));
    } else if (at_high == 0.0 && at_low != 0.0) {
      out.push_back(high);  // a change of sign only if it continues beyond
    }
    low = high;
    at_low = at_high;
  }
  return out;
}

std::vector<double> extremes_of(const Exponentials& f, double end_s) {
  Exponentials slope;
  for (const Exponential& term : f) {
    slope.push_back({-term.amplitude * term.rate_1_s, term.rate_1_s});
  }
  return sign_changes(std::move(slope), end_s);
}

}  // namespace steadyrest::thermal::offline
