// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <bench/clairvoyant/clairvoyant.hpp>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

/// The clairvoyant schedule of a part, as the simulated machine really runs it.
namespace steadyrest::bench::clairvoyant {

struct Yardstick {
  trial::cut::Figures figures;  ///< of the fastest schedule that keeps the limit
  Schedule bound;               ///< that no real result can reach: changes of speed take no time
};

/// Every permitted step is run over the whole part, which gives time and error of each stretch at
/// that step; dynamic programming picks the best sequence; that sequence is run again, since only
/// the simulation knows what its transitions cost. `tell`: a line for each run. Refused: what the
/// simulated machine refuses, and a part on which no schedule keeps the limit.
[[nodiscard]] kernel::outcome::Result<Yardstick> yardstick_of(
    const trial::cut::Job& job, const std::function<void(const std::string&)>& tell);

/// The share of samples over the limit.
[[nodiscard]] double share_over(const trial::cut::Figures& figures);

}  // namespace steadyrest::bench::clairvoyant
