// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <steadyrest/contour/offline/identify/servo_checks.hpp>
#include <steadyrest/contour/offline/learn/fitted_axes.hpp>
#include <steadyrest/math/geometry/moves.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::outcome::Result;
using Axes = std::vector<Axis>;

constexpr double kClearly = 0.7;
constexpr double kFirstLag = 0.1;  ///< of 1/k: the fit begins with it

std::vector<std::size_t> moved(kernel::signal::PathView path, std::size_t axes) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes); ++i) {
    if (std::ranges::any_of(
            path, [i](const auto& segment) { return math::geometry::moves(segment, i); })) {
      out.push_back(i);
    }
  }
  return out;
}

ServoLog log_of(const PartRecord& record, std::size_t place) {
  ServoLog log{.time_s = record.time_s, .command = {}, .actual = {}};
  for (std::size_t n = 0; n < record.size(); ++n) {
    log.command.push_back(record.command_mm[n][place]);
    log.actual.push_back(record.actual_mm[n][place]);
  }
  return log;
}

void put(Axis& axis, double gain_1_s, double feed_forward, double lag_s) {
  axis.servo_gain_1_s = gain_1_s;
  axis.feed_forward = feed_forward;
  axis.velocity_lag_s = lag_s;
  axis.velocity_lag_known = true;
}

/// By fit_servos(). Nothing where it does not determine all of them.
std::optional<Axes> by_all_numbers(const PartRecord& record, const std::vector<std::size_t>& places,
                                   Axes axes) {
  std::vector<ServoLog> logs;
  Axes fitted;
  for (const std::size_t place : places) {
    logs.push_back(log_of(record, place));
    fitted.push_back(axes[place]);
  }
  const auto fits = fit_servos(logs, fitted);
  if (!fits || !std::ranges::all_of(fits->axes, &ServoFit::determined)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ServoFit& fit = fits->axes[i];
    put(axes[places[i]], fit.gain_1_s, fit.feed_forward, fit.lag_s);
  }
  return axes;
}

/// Gain and lag alone.
std::optional<Axes> by_gain_and_lag(const PartRecord& record,
                                    const std::vector<std::size_t>& places, Axes axes) {
  for (const std::size_t place : places) {
    Axis& axis = axes[place];
    const ServoLog log = log_of(record, place);
    const auto subject = prepared_subject(axis, log, servo_period_s(log.time_s));
    if (!subject) {
      return std::nullopt;
    }
    const ServoProblem problem = first_of(subject->problem, kFittedSamples);
    const ServoForm form = ServoForm{}.with({Free::lag});
    const ServoLaw start = {.gain_1_s = axis.servo_gain_1_s,
                            .feed_forward = axis.feed_forward,
                            .lag_s = kFirstLag / axis.servo_gain_1_s};
    const ServoLaw white = fit_law(problem, start, form, {}).law;
    const ServoLaw law = fit_law(problem, white, form, colour_of(problem, white)).law;
    put(axis, law.gain_1_s, axis.feed_forward, law.lag_s);
  }
  return axes;
}

bool is_sound(const Axes& axes, const std::vector<std::size_t>& places) {
  return std::ranges::all_of(places, [&](std::size_t place) {
    const Axis& axis = axes[place];
    return axis.servo_gain_1_s >= 1.0 && axis.servo_gain_1_s <= 1000.0 &&
           axis.velocity_lag_s >= 0.0 && axis.velocity_lag_s * axis.servo_gain_1_s < 1.0;
  });
}

/// What the records show beyond these axes, RMS.
Result<double> misfit_mm(const std::vector<CutPart>& parts, Lessons lessons, const Axes& axes) {
  lessons.model = servo_models(axes);
  const auto learnt = learn_from(parts, lessons);
  if (!learnt) {
    return std::unexpected(learnt.error());
  }
  double sum = 0.0;
  for (const LearningFigures& figures : learnt->figures) {
    sum += figures.misfit_rms_mm * figures.misfit_rms_mm;
  }
  return std::sqrt(sum);
}

/// Axes that the path does not move are as stiff as the others: they do not keep cautious() from
/// taking the gains that the record shows.
void align_rest(Axes& axes, const std::vector<std::size_t>& places) {
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()) && !places.empty(); ++i) {
    if (std::ranges::find(places, i) == places.end()) {
      axes[i].servo_gain_1_s = axes[places.front()].servo_gain_1_s;
    }
  }
}

online::AxisModel model_of(const Axis& axis) noexcept {
  return {.gain_1_s = axis.servo_gain_1_s,
          .feed_forward = axis.feed_forward,
          .velocity_lag_s = axis.velocity_lag_s};
}

}  // namespace

Result<std::vector<FittedAxis>> fit_axes(const std::vector<CutPart>& parts, const Lessons& lessons,
                                         Axes& axes) {
  const auto by_file = misfit_mm(parts, lessons, axes);
  const auto places = moved(lessons.original.segments, axes.size());
  double least = by_file ? kClearly * *by_file : std::numeric_limits<double>::infinity();
  std::optional<Axes> best;
  for (const CutPart& part : parts) {
    for (const auto& fit : {by_all_numbers, by_gain_and_lag}) {
      auto other = fit(part.record, places, axes);
      const auto misfit = other && is_sound(*other, places) ? misfit_mm(parts, lessons, *other)
                                                            : Result<double>(least);
      if (misfit && *misfit < least) {
        least = *misfit;
        best = std::move(other);
      }
    }
  }
  if (!by_file && !best) {
    return std::unexpected(by_file.error());
  }
  std::vector<FittedAxis> out;
  for (std::size_t i = 0; best && i < places.size(); ++i) {
    const Axis& was = axes[places[i]];
    out.push_back({.name = was.name,
                   .was = model_of(was),
                   .is = model_of((*best)[places[i]]),
                   .lag_was_known = was.velocity_lag_known});
  }
  if (best) {
    axes = std::move(*best);
    align_rest(axes, places);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
