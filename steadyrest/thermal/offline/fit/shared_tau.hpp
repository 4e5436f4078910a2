// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/thermal/offline/fit/identify.hpp>

namespace steadyrest::thermal::offline {

/// Displacements of one machine whose modes share time constants because the same bodies move them.
/// Fits with the same number of modes get the mean of their ln τ, weighted by certainty, and are
/// fitted again. The result stays if their joint evidence loses less than ½ ln(rows) for each time
/// constant saved (Bayes' criterion). The most alike are tried first.
///
/// `channel` of the log and `fit` correspond. Returns the groups that share, as places in `fit`,
/// each of two or more.
std::vector<std::vector<std::size_t>> share_tau(const Log& log,
                                                const std::vector<std::size_t>& channel,
                                                const FitRequest& request,
                                                std::vector<AxisFit>& fit);

}  // namespace steadyrest::thermal::offline
