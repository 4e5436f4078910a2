// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predistort/followed_run.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_window.hpp>
#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

struct PolishTask {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& path;  ///< of the original
  ServoModels models;
  /// What the tool is off by beyond the models, by original path length; none: nothing.
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::function<kernel::signal::Point(double foot_mm)> unknown = {};
  ChainPrice price;
  double most_shift_mm = 0.5;                 ///< from the path
  static constexpr double kTimeToHold = 1.0;  ///< price of a second where the limit comes first
  static constexpr std::size_t kInner = 3;
  std::size_t inner = kInner;  ///< pieces that a window changes
  bool unites = false;         ///< pieces of one block may become fewer
  /// Windows reach everywhere: small bends are taken away, long arcs divided, and pieces of one
  /// slope have one.
  bool thorough = false;
  std::function<void(double share)> progress = [](double) {};  ///< of a sweep, to 1
};

/// Makes the pieces of a command better, window by window (ChainWindow), once from the first to the
/// last. `starts`: of the blocks, as followed last. Spirals, pieces that rise steeply and those at
/// bends stay, and so does what would go too far from the path. A part with very many windows that
/// are worth it is left as it is where the work ends.
[[nodiscard]] std::vector<Piece> polished(const PolishTask& task,
                                          const std::vector<BlockStart>& starts,
                                          const std::vector<Piece>& pieces);

}  // namespace steadyrest::contour::offline
