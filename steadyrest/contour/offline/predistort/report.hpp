// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/contour/offline/predistort/predistort.hpp>

namespace steadyrest::contour::offline {

/// What follows from the figures before and after: the worst machine's, and the blocks that stay
/// above the limit.
void add_report(Predistorted& done, double limit_mm);

}  // namespace steadyrest::contour::offline
