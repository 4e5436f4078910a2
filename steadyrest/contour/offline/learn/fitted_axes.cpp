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

/// Axes, and how well a record shows the gains of those that it shows.
struct Axes {
  std::vector<Axis> all;
  std::vector<double> gain_sd_1_s;  ///< in the order of the places
};

constexpr double kClearly = 0.7;
constexpr double kFirstLag = 0.1;  ///< of 1/k: the fit begins with it

std::vector<std::size_t> moved(kernel::signal::PathView path, std::size_t axes) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes); ++i) {
    if (math::geometry::moves(path, i)) {
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
                                   const std::vector<Axis>& axes) {
  std::vector<ServoLog> logs;
  std::vector<Axis> fitted;
  for (const std::size_t place : places) {
    logs.push_back(log_of(record, place));
    fitted.push_back(axes[place]);
  }
  const auto fits = fit_servos(logs, fitted);
  if (!fits || !std::ranges::all_of(fits->axes, &ServoFit::determined)) {
    return std::nullopt;
  }
  Axes out{.all = axes, .gain_sd_1_s = {}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ServoFit& fit = fits->axes[i];
    put(out.all[places[i]], fit.gain_1_s, fit.feed_forward, fit.lag_s);
    out.gain_sd_1_s.push_back(fit.gain_sd_1_s);
  }
  return out;
}

/// Gain and lag alone.
std::optional<Axes> by_gain_and_lag(const PartRecord& record,
                                    const std::vector<std::size_t>& places,
                                    const std::vector<Axis>& axes) {
  Axes out{.all = axes, .gain_sd_1_s = {}};
  for (const std::size_t place : places) {
    Axis& axis = out.all[place];
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
    ServoFitted fit = fit_law(problem, white, form, colour_of(problem, white));
    put_variance(problem, fit);
    put(axis, fit.law.gain_1_s, axis.feed_forward, fit.law.lag_s);
    out.gain_sd_1_s.push_back(fit.sd(Free::gain));
  }
  return out;
}

bool is_sound(const std::vector<Axis>& axes, const std::vector<std::size_t>& places) {
  return std::ranges::all_of(places, [&](std::size_t place) {
    const Axis& axis = axes[place];
    return axis.servo_gain_1_s >= 1.0 && axis.servo_gain_1_s <= 1000.0 &&
           axis.velocity_lag_s >= 0.0 && axis.velocity_lag_s * axis.servo_gain_1_s < 1.0;
  });
}

/// What the records show beyond these axes, RMS.
Result<double> misfit_mm(const std::vector<CutPart>& parts, Lessons lessons,
                         const std::vector<Axis>& axes) {
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
void align_rest(std::vector<Axis>& axes, const std::vector<std::size_t>& places) {
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()) && !places.empty(); ++i) {
    if (std::ranges::find(places, i) == places.end()) {
      axes[i].servo_gain_1_s = axes[places.front()].servo_gain_1_s;
    }
  }
}

}  // namespace

Result<std::vector<FittedAxis>> fit_axes(const std::vector<CutPart>& parts, const Lessons& lessons,
                                         std::vector<Axis>& axes) {
  const auto by_file = misfit_mm(parts, lessons, axes);
  const auto places = moved(lessons.original.segments, axes.size());
  double least = by_file ? kClearly * *by_file : std::numeric_limits<double>::infinity();
  std::optional<Axes> best;
  for (const CutPart& part : parts) {
    for (const auto& fit : {by_all_numbers, by_gain_and_lag}) {
      auto other = fit(part.record, places, axes);
      if (!other || !is_sound(other->all, places)) {
        continue;
      }
      const auto misfit = misfit_mm(parts, lessons, other->all);
      if (misfit && *misfit < least) {
        least = *misfit;
        best = std::move(other);
      }
    }
  }
  std::vector<FittedAxis> out;
  if (!best) {
    return by_file ? Result<std::vector<FittedAxis>>(out) : std::unexpected(by_file.error());
  }
  const ServoModels was = servo_models(axes);
  const ServoModels is = servo_models(best->all);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Axis& axis = axes[places[i]];
    out.push_back({.name = axis.name,
                   .was = was[places[i]],
                   .is = is[places[i]],
                   .gain_sd_1_s = best->gain_sd_1_s[i],
                   .lag_was_known = axis.velocity_lag_known});
  }
  axes = std::move(best->all);
  align_rest(axes, places);
  return out;
}

}  // namespace steadyrest::contour::offline
