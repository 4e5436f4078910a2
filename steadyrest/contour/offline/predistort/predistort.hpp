// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/contour/offline/learn/fitted_axes.hpp>
#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/contour/offline/predistort/round_score.hpp>
#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::contour::offline {

/// Writes the inverse of the servos into a program: the contour error cancelled by the text alone.
///
/// The planned motion of the control gives the command's speed, ToolMotion the motion of a tool
/// that stays on the path, CommandShape the curve that must be commanded for it, as lines and arcs.
/// Kinks are rounded and corners led beyond (joints). The changed text is planned again: the
/// control now moves at another speed, so the curve is made for that speed, a few rounds. The best
/// round is kept.
///
/// Bounded: where the command would leave the path by more than `max_shift_mm` the block stays. The
/// control plans what is written, so no axis exceeds its speed, acceleration or jerk. Robust: the
/// error of the changed program is worked out for every model whose gains and lags are all off by
/// their uncertainty, each axis up or down; a block that comes out worse on any of them stays.
/// Proved (nc/rewrite/tube/prove_made): where the proof or the control would refuse what is
/// written, the blocks there stay.
struct PredistortConfig {
  double limit_mm = 0.01;
  double max_shift_mm = 0.5;
  double gain_uncertainty = 0.05;  ///< of each axis's servo gain, 0 … 0.3
  /// Of the velocity loops' lags, in 1/k, 0 … 0.5. None: as ServoUncertainty::of() says. Where
  /// parts teach it bounds what may come after the best of them, not the blocks.
  std::optional<double> lag_uncertainty = std::nullopt;
  int rounds = 4;
  /// Of the program's own time; a slower round does not count, but is named if it wins much.
  double most_time = RoundScore::kUsualTime;
  /// Feeds fall where the predicted error stays above this (FeedCaps), the cut waits where a rapid
  /// has left it (RapidWaits), and the program takes longer; 0: all feeds stay.
  double hold_mm = 0.0;
  /// Parts cut before, to learn from (learn/). They say what the servos are, where they determine
  /// it (fit_axes()), and the best of their programs stays where the new one is not surely better
  /// (better_part()).
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::vector<CutPart> parts = {};
  /// For the mark in the program; its tube bounds the shift too.
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::vector<nc::rewrite::Told> told = {};
  std::function<void(double share, std::string_view what)> progress = [](double, auto) {};
};

/// A block whose predicted error stays above the limit.
struct Remaining {
  std::uint32_t line = 0;
  double before_mm = 0.0;
  double after_mm = 0.0;
};

struct Predistorted : PredictedChange {
  nc::rewrite::NewLines lines;  ///< in place of the program's
  nc::rewrite::Replaced replaced;
  std::vector<LearningFigures> learnt;  ///< from each part
  std::vector<FittedAxis> fitted;       ///< axes that parts have shown to be other than the file's
  std::vector<kernel::machine::Axis> axes;  ///< that it was made for
  Learnt taught;                            ///< what parts have shown beyond these axes
  std::optional<std::size_t> kept_part;     ///< whose program it is, since none was surely better
  /// Over all models within the uncertainty.
  double worst_before_mm = 0.0;
  double worst_after_mm = 0.0;
  double worst_rms_before_mm = 0.0;
  double worst_rms_after_mm = 0.0;
  OtherModels others;                     ///< that judged it
  double gain_uncertainty = 0.0;          ///< of the gains; less where parts have shown them
  double lag_uncertainty = 0.0;           ///< in 1/k: the largest of the axes that move
  std::vector<std::string> unknown_lags;  ///< axes that move, whose lag the machine file lacks
  double largest_shift_mm = 0.0;
  Waits waits;  ///< dwells between a rapid and the cut
  std::optional<Slower> slower;
  std::vector<Remaining> remaining;  ///< the worst first
  std::vector<std::uint32_t>
      past_travel;                      ///< lines that stay, since an axis would leave its travel
  std::vector<std::uint32_t> too_far;   ///< lines that stay, since the shift would be too large
  std::vector<std::uint32_t> worse;     ///< lines that stay, since some model makes them worse
  std::vector<std::uint32_t> unproved;  ///< lines that stay, since no proof was found
};

/// Refused: what the interpreter or planner refuses; a program that cuts nothing.
[[nodiscard]] kernel::outcome::Result<Predistorted> predistort(
    const std::string& program, const nc::interpret::Config& config,
    const kernel::machine::Machine& machine, const PredistortConfig& how);

}  // namespace steadyrest::contour::offline
