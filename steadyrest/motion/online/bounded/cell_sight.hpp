// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/motion/online/bounded/lanes.hpp>
#include <steadyrest/motion/online/bounded/model_bank.hpp>

/// A count tells only the cell that contains the position: what the models learn from that.
namespace steadyrest::motion::online {

/// What the cell [low, high] tells each model.
struct CellSight {
  Lanes share = all(1.0);  ///< of each model inside the cell
  bool any = false;        ///< it tells at least one of them something; z and r are set
  Lanes z{}, r{};          ///< the measurement that gives the truncated normal's moments
  Lanes variance{};        ///< of the models' positions
};
[[nodiscard]] CellSight see_cell(const ModelBank& bank, double low, double high) noexcept;

/// The position is known to lie in [low, high]: replaces the normal distribution by one with the
/// moments of the truncated one. Returns each model's share inside.
[[nodiscard]] Lanes truncate(ModelBank& bank, double low, double high) noexcept;

}  // namespace steadyrest::motion::online
