// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <steadyrest/thermal/offline/fit/identify.hpp>

/// What a log cannot support.
namespace steadyrest::thermal::offline {

/// Before the fit: too few readings, a spindle that never turns, a horizon of more than twice the
/// longest run at one speed, sensors of the known passport that the log lacks, and, if a table of
/// levels is requested, too few or too many held speeds.
[[nodiscard]] std::optional<kernel::outcome::Refusal> unfit(const FitData& data,
                                                            const FitRequest& request,
                                                            const std::vector<double>& table_rev_s);

/// After the fit: a forecast over the horizon that is uncertain by more than a quarter of the
/// measured range, or, without left-out blocks, a time constant that no run is long enough to show.
[[nodiscard]] std::optional<kernel::outcome::Refusal> too_uncertain(const AxisFit& fit,
                                                                    const FitData& data,
                                                                    const FitRequest& request);

}  // namespace steadyrest::thermal::offline
