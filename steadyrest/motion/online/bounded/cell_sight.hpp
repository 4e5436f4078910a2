// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/motion/online/bounded/lanes.hpp>
#include <steadyrest/motion/online/bounded/model_bank.hpp>

/// A count says only in which cell the position lies: what the models learn from that.
namespace steadyrest::motion::online {

/// What the cell [low, high] says to each model.
struct CellSight {
  Lanes share = all(1.0);  ///< of each model that lay inside
  bool any = false;        ///< it says something to one of them at least; z and r are set
  Lanes z{}, r{};          ///< the measurement that would bring the moments of the truncated normal
  Lanes variance{};        ///< of the models' positions
};
[[nodiscard]] CellSight see_cell(const ModelBank& bank, double low, double high) noexcept;

/// The position is known to lie in [low, high]: the normal distribution is replaced by one with the
/// moments of the truncated one. Gives the share of each model that lay inside.
[[nodiscard]] Lanes truncate(ModelBank& bank, double low, double high) noexcept;

}  // namespace steadyrest::motion::online
