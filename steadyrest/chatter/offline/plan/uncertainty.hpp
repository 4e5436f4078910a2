// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>

/// The uncertainty of a cut: relative standard deviations of its figures.
///
/// A Latin hypercube: over n samples each figure takes every n-th part of its distribution once, so
/// the share of stable samples is known to about 1/n where one figure decides. Frequencies f·(1 +
/// σg) and damping ratios ζ·e^{σg} vary independently for each mode, Kt and Kr by k·e^{σg}; g
/// is normal with variance 1. Source: McKay, Beckman, Conover, Technometrics 21 (1979) 239.
namespace steadyrest::chatter::offline {

struct Uncertainty {
  double frequency = 0.005;    ///< σ of natural frequencies, 0 … 0.1
  double damping = 0.10;       ///< σ of damping ratios, 0 … 1
  double coefficients = 0.10;  ///< σ of Kt and of Kr, 0 … 1
  std::size_t samples = 32;    ///< 1 … 4096
  std::uint64_t seed = 1;
};

/// `samples` cuts; the same ones for the same seed.
[[nodiscard]] std::vector<Process> possible_cuts(const Process& process, const Uncertainty& of);

}  // namespace steadyrest::chatter::offline
