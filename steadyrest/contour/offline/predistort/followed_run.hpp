// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/stretches.hpp>
#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/contour/offline/predistort/run_errors.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>
#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>

namespace steadyrest::contour::offline {

/// The axes at the last sample before the command goes to another block of the original.
struct BlockStart {
  double progress_mm = 0.0;  ///< of that sample
  double foot_mm = 0.0;
  double speed_mm_s = 0.0;  ///< of the command
  AxesState axes;
  kernel::signal::Point next_error_mm{};  ///< behind the command, one sample later
};

/// A changed program on the servo model.
struct FollowedRun {
  double seconds = 0.0;
  ErrorFigures figures;
  CommandSpeed speed;
  std::vector<double> corner_mm;    ///< largest error near each corner
  std::vector<ErrorSample> errors;  ///< what refinements are made from
  std::vector<ErrorPlace> over;     ///< above Judging::hold_mm, in order
  std::vector<BlockStart> starts;   ///< in order
  RunErrors runs;
};

/// What every run is judged by.
struct Judging {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& original;
  const ServoModels& model;
  const OtherModels& others;
  const Learnt& learnt;  ///< what records have shown beyond the model
  const CutRuns& runs;
  double limit_mm = 0.01;
  double hold_mm = 0.0;  ///< 0: no place is over it
  std::function<void(double share)> progress = [](double) {};
};

[[nodiscard]] kernel::outcome::Result<FollowedRun> follow(const Judging& by, const Changed& changed,
                                                          const std::vector<Corner>& corners);

}  // namespace steadyrest::contour::offline
