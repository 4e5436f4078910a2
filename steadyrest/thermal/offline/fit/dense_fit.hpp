// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/thermal/offline/fit/structure_search.hpp>

namespace steadyrest::thermal::offline {

/// A structure with every temperature at lags of 0, 60 and 400 min, all gains small a priori: N(0,
/// s²). The usual gain s, the usual levels and the modes are those of the greatest evidence, with
/// gains and levels integrated out; so no sensor is chosen by the hours that it happens to fit.
/// Levels have both powers of the speed. The modes' time constants are the grid's.
struct Dense {
  Structure structure;
  ErrorModel error;  ///< the likeliest for it
};

/// None if the limits let a structure take every temperature anyway, nor for more than 21.
[[nodiscard]] std::optional<Dense> dense_fit(const FitData& data, const ErrorModel& guess,
                                             const SearchLimits& limits, std::size_t least_modes);

}  // namespace steadyrest::thermal::offline
