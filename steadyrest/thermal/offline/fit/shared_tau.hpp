// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/thermal/offline/fit/identify.hpp>

namespace steadyrest::thermal::offline {

/// Displacements of one machine whose modes have the same time constants, because the same bodies
/// move them: fits of as many modes are given the mean of their ln τ, weighed by its certainty, and
/// fitted again. That stays where the evidence of all together loses less than ½ ln(rows) for each
/// time constant that is saved (Bayes' criterion). The most alike are tried first.
///
/// `channel` of the log and `fit` go together. Returns the groups that share, as places in `fit`,
/// each of two or more.
std::vector<std::vector<std::size_t>> share_tau(const Log& log,
                                                const std::vector<std::size_t>& channel,
                                                const FitRequest& request,
                                                std::vector<AxisFit>& fit);

}  // namespace steadyrest::thermal::offline
