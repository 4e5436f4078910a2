// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// An error that is known at a place of the original path.
struct ErrorSample {
  bool valid = false;  ///< else a gap is here
  bool fades = false;  ///< a gap that what is learnt must fade towards; else nothing is cut here
  double time_s = 0.0;
  double foot_mm = 0.0;
  kernel::signal::Point off_mm{};  ///< from the tool to its foot
};

/// The displacement that cancels errors: u = Q·L·off, L = 1 + g·d/dt.
///
/// Q and L are one local fit (local_fit.hpp) in time, zero phase. Stretches end at corners and at
/// gaps; samples whose foot does not move on are left out. Beside a gap that fades, the weight
/// falls to 0 within 3σ.
[[nodiscard]] std::vector<Learnt::Stretch> stretches_of(const std::vector<ErrorSample>& samples,
                                                        const SharpCorners& corners,
                                                        const std::array<double, 3>& lags_s,
                                                        double sigma_s);

}  // namespace steadyrest::contour::offline
