// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include <steadyrest/chatter/offline/response/uff_function.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The units of a universal file's axes. A label decides (mm, g, lbf); without one dataset 164
/// does, and without that SI. Refused: unknown labels, and a label beside another unit in dataset
/// 164: the data may be in either.
namespace steadyrest::chatter::offline {

/// Hz per unit of the abscissa: Hz, kHz, rad/s, rpm.
[[nodiscard]] kernel::outcome::Result<double> hz_of(const UffFunction& function);

struct UffScale {
  double mm_n = 1.0;  ///< mm/N, or its derivative's, per unit of the ordinate
  int order = 0;      ///< 0: displacement, 1: velocity, 2: acceleration
};
/// Of a response over force; `to_s` are names for refusals.
[[nodiscard]] kernel::outcome::Result<UffScale> scale_of(const UffFunction& function);

}  // namespace steadyrest::chatter::offline
