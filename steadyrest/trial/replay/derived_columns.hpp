// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/sample.hpp>

namespace steadyrest::trial::replay {

/// What a table of a recorded run has in addition to the record: `contour_error_mm`, the distance
/// of the axes' actual point from the path as the layer saw it, with the sign of
/// `contour/online/contour_error`; NaN where it had no estimate and outside cuts. The columns have
/// a state: give them each sample once, in order. None for a run whose machine file cannot be read
/// any more.
[[nodiscard]] std::vector<record::Derived> derived_columns(const record::RunInfo& run);

}  // namespace steadyrest::trial::replay
