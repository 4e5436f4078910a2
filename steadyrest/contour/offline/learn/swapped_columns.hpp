// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// What tells that columns of a record have each other's names: a sentence that names them, empty
/// where none look swapped. `path` is what the control ran.
///
/// Law. 1. Commanded and measured positions are near each other: where another order of the
/// measured axes comes ten times nearer, axes are swapped, on the side that leaves the path.
/// 2. Commands are on the path: where a tenth of them is not and another order of the axes puts
/// them there, both sides are swapped. 3. The measured position trails: an axis whose measured
/// position runs ahead of the commanded one, L̂ = Σ ċ·(c − x) / Σ ċ² < −max(g/2, 2 samples) with g =
/// (1 − a)/k of the model, has both swapped. With full feed-forward nothing trails, and 3 finds
/// nothing.
[[nodiscard]] std::string swapped_columns(const PartRecord& record, kernel::signal::PathView path,
                                          const ServoModels& model);

}  // namespace steadyrest::contour::offline
