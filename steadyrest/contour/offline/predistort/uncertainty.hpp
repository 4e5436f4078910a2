// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>

namespace steadyrest::contour::offline {

/// The corners of the uncertainty: each axis's gain off by the share, up or down. Empty for a share
/// of 0.
[[nodiscard]] std::vector<ServoModels> uncertain(const ServoModels& model, double share);

/// Gains within the uncertainty that are as equal as they can be. Unequal gains bend straight
/// lines; a difference that may not be there must not be corrected, or a machine without it would
/// get it.
[[nodiscard]] ServoModels cautious(const ServoModels& model, double share);

}  // namespace steadyrest::contour::offline
