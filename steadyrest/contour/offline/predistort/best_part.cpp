// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/contour/offline/predict/paired.hpp>
#include <steadyrest/contour/offline/predistort/best_part.hpp>
#include <steadyrest/contour/offline/predistort/run_errors.hpp>
#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/passport/text/text_file.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;
using Figures = ErrorFigures::Whole;

constexpr double kPartGrows = 1.05;  ///< the largest error, as the RMS falls …
constexpr double kMuchBetter = 0.5;  ///< … and where it falls to less than this, any
constexpr double kExplains = 2.0;    ///< of the model's misfit: no more explains the record too
constexpr std::array kLags = {0.25, 0.5};  ///< in 1/k
constexpr double kNoLag_s = 1e-9;

/// A part's program as a change of the original. Nothing where it is none.
Result<std::optional<Changed>> as_change(const BestPartTask& task, const CutPart& part) {
  const auto back = nc::rewrite::put_back(part.program);
  const auto original = passport::read_text(task.file);
  if (!back || !original || back->text != *original) {
    return std::optional<Changed>();
  }
  Changed out;
  out.lines = back->lines;
  auto text = nc::rewrite::replace(task.file, task.lessons.config.dialect, out.lines, task.told);
  auto path = text ? nc::plan::plan_text(text->text, task.lessons.config, task.lessons.machine,
                                         part.program)
                   : std::unexpected(text.error());
  if (!path) {
    return std::unexpected(path.error());
  }
  const auto pairing = math::geometry::PathPairing::make(
      path->segments, task.lessons.original.segments, {.tube_mm = LearnConfig{}.tube_mm});
  if (!pairing) {
    return std::optional<Changed>();
  }
  PathMap map = paired(*path, *pairing);
  out.replaced = std::move(*text);
  out.path = std::move(*path);
  out.start_mm = std::move(map.start_mm);
  out.end_mm = std::move(map.end_mm);
  return out;
}

double largest_shift_mm(const Changed& program, const nc::plan::PlannedPath& original) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < program.path.segments.size(); ++i) {
    const auto& segment = program.path.segments[i];
    if (segment.motion == kernel::signal::Motion::feed) {
      pieces.push_back({.segment = segment,
                        .progress_start_mm = program.start_mm[i],
                        .progress_end_mm = program.end_mm[i]});
    }
  }
  return shift_of(original, pieces, LearnConfig{}.tube_mm).largest_mm;
}

/// What a program leaves where a record has shown what the tool does.
Result<Figures> left(const BestPartTask& task, const ServoModels& model, const Learnt& learnt,
                     const Changed& program) {
  const kernel::machine::Machine& machine = task.lessons.machine;
  const PathMap map{.start_mm = program.start_mm, .end_mm = program.end_mm};
  Figures out;
  const auto seconds =
      run_model({.machine = machine,
                 .path = program.path,
                 .original = task.lessons.original,
                 .map = map,
                 .model = model,
                 .others = {},
                 .backlash_mm = backlash_mm(machine.axes),
                 .unknown = [&](double foot_mm) { return learnt.unknown_mm(foot_mm); }},
                [&](const ModelSample& sample) {
                  if (sample.cuts && learnt.covers(sample.foot_mm)) {
                    const double error = std::abs(sample.error_mm);
                    out.add(error, error + sample.more_mm);
                  }
                });
  return seconds ? Result<Figures>(out) : std::unexpected(seconds.error());
}

struct Taught {
  Learnt learnt;
  double misfit_mm = 0.0;
};

/// What a part's record shows beyond a model. Nothing is learnt from it, so convergence is not
/// required.
Result<Taught> taught(const BestPartTask& task, const ServoModels& model, const CutPart& part,
                      const Changed& program) {
  LearnConfig config;
  config.uncertainty = {.gain_share = 0.0, .velocity_lag_s = kNoLag_s, .feed_forward = 0.0};
  Taught out;
  const auto figures = learn({.machine = task.lessons.machine,
                              .original = task.lessons.original,
                              .cut = program.path,
                              .record = part.record,
                              .model = model},
                             config, out.learnt);
  if (!figures) {
    return std::unexpected(figures.error());
  }
  out.misfit_mm = figures->misfit_rms_mm;
  return out;
}

struct Candidate {
  BestPart best;
  Taught taught;
  double rms_mm = 0.0;
};

Result<std::optional<Candidate>> best_of(const BestPartTask& task) {
  std::optional<Candidate> out;
  const ServoModels& model = task.lessons.model;
  for (std::size_t i = 0; i < task.parts.size(); ++i) {
    auto change = as_change(task, task.parts[i]);
    if (!change) {
      return std::unexpected(change.error());
    }
    if (!*change) {
      continue;
    }
    auto shown = taught(task, model, task.parts[i], **change);
    if (!shown) {
      continue;  // of so large errors it is not the best
    }
    const auto figures = left(task, model, shown->learnt, **change);
    if (!figures) {
      return std::unexpected(figures.error());
    }
    if (!out || figures->rms_mm() <= out->rms_mm) {
      out = Candidate{.best = {.part = i, .program = std::move(**change)},
                      .taught = std::move(*shown),
                      .rms_mm = figures->rms_mm()};
    }
  }
  return out;
}

/// The model, with other lags on all axes.
std::vector<ServoModels> with_lags(const ServoModels& model) {
  std::vector<ServoModels> out = {model};
  for (const double lag : kLags) {
    ServoModels& other = out.emplace_back(model);
    for (online::AxisModel& axis : other) {
      axis.velocity_lag_s = lag / axis.gain_1_s;
    }
  }
  return out;
}

/// The model, and its gains up and down.
std::vector<ServoModels> with_gains(const ServoModels& model, double share,
                                    kernel::signal::PathView path) {
  std::vector<ServoModels> out = {model};
  const OtherModels others = uncertain(model, {.gain = share}, path);
  for (std::size_t i = 0; i < others.size(); ++i) {
    out.push_back(others[i]);
  }
  return out;
}

bool grows(const Figures& was, const Figures& is) noexcept {
  return is.rms_mm() > was.rms_mm() + RunErrors::kRounding_mm ||
         (is.rms_mm() > kMuchBetter * was.rms_mm() &&
          is.max_mm > kPartGrows * was.max_mm + RunErrors::kRounding_mm);
}

}  // namespace

Result<std::optional<BestPart>> better_part(const BestPartTask& task, const Changed& made) {
  auto best = best_of(task);
  if (!best) {
    return std::unexpected(best.error());
  }
  if (!*best || (*best)->best.program.lines == made.lines) {
    return std::optional<BestPart>();
  }
  Candidate& candidate = **best;
  const CutPart& part = task.parts[candidate.best.part];
  const double most_mm = kExplains * candidate.taught.misfit_mm + RunErrors::kRounding_mm;
  for (const ServoModels& of_lag : with_lags(task.lessons.model)) {
    for (const ServoModels& model :
         with_gains(of_lag, task.lessons.gain_uncertainty, task.lessons.original.segments)) {
      const auto shown = taught(task, model, part, candidate.best.program);
      if (!shown || shown->misfit_mm > most_mm) {
        continue;
      }
      const auto was = left(task, model, shown->learnt, candidate.best.program);
      const auto is = left(task, model, shown->learnt, made);
      if (!was || !is) {
        return std::unexpected((was ? is : was).error());
      }
      if (grows(*was, *is)) {
        candidate.best.largest_shift_mm =
            largest_shift_mm(candidate.best.program, task.lessons.original);
        return std::optional(std::move(candidate.best));
      }
    }
  }
  return std::optional<BestPart>();
}

}  // namespace steadyrest::contour::offline
