// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/causes/places.hpp>
#include <steadyrest/contour/offline/feeds/rapid_lag.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;

constexpr double kLeastAngle_rad = 2.0 * std::numbers::pi / 180.0;
constexpr double kReach_mm = 0.05;
constexpr double kStopping = 0.01;
constexpr double kEqualLags = 1.02;

/// The stretch of the original between the tool and the command, and as much before it.
std::pair<double, double> stretch_of(const Peak& peak) noexcept {
  const double lead = std::abs(peak.progress_mm - peak.foot_mm);
  return {std::min(peak.foot_mm, peak.progress_mm) - lead - kReach_mm,
          std::max(peak.foot_mm, peak.progress_mm) + kReach_mm};
}

/// The tightest arc that has to do with an error; null: none.
const PathSegment* tightest_arc(const OverTask& task, const Peak& peak) {
  const auto& segments = task.original.segments;
  const auto [from, to] = stretch_of(peak);
  const PathSegment* tightest = nullptr;
  for (std::size_t i = math::geometry::segment_at(segments, from);
       i < segments.size() && segments[i].position_mm <= to; ++i) {
    if (segments[i].geometry == Geometry::arc && segments[i].motion == Motion::feed &&
        (tightest == nullptr || segments[i].radius_mm < tightest->radius_mm)) {
      tightest = &segments[i];
    }
  }
  return tightest;
}

/// The text is in shorter blocks there than the control takes at that speed.
std::string block_words(const OverTask& task, const Peak& peak) {
  const auto& control = task.machine.control;
  const double least_s = kernel::machine::least_block_s(control);
  const PathSegment& segment = task.path.segments[peak.segment];
  if (!(least_s > control.interpolator_period_s) ||
      segment.length_mm >= 1.01 * least_s * segment.feed_mm_s) {
    return {};
  }
  return fmt::format(", in blocks of {:.2g} mm that take {:g} ms each", segment.length_mm,
                     1000.0 * least_s);
}

std::string path_reason(const OverTask& task, const Peak& peak) {
  using kernel::units::deg_from_rad;
  const double feed_mm_min = kernel::units::mm_min_from_mm_s(peak.speed_mm_s);
  const auto corner = corner_at(task, peak);
  const PathSegment* arc = tightest_arc(task, peak);
  if (corner && (arc == nullptr || deg_from_rad(corner->angle_rad) > 10.0)) {
    return fmt::format("corner of {:.0f}° at the end of line {}", deg_from_rad(corner->angle_rad),
                       corner->line);
  }
  if (arc != nullptr) {
    return peak.speed_mm_s < kStopping * arc->feed_mm_s
               ? fmt::format("arc of {:.3g} mm, as the command stops", arc->radius_mm)
               : fmt::format("arc of {:.3g} mm at F{:.0f}", arc->radius_mm, feed_mm_min);
  }
  const auto lags = first_lags_s(servo_models(task.machine.axes));
  const auto [least, most] = std::ranges::minmax(lags);
  if (most > kEqualLags * least) {
    return fmt::format("the axes lag differently, by {:.1f} to {:.1f} ms", 1000.0 * least,
                       1000.0 * most);
  }
  return fmt::format("what the path before it left, at F{:.0f}", feed_mm_min);
}

}  // namespace

Result<std::vector<Peak>> peaks_over(const OverTask& task) {
  std::map<std::uint32_t, Peak> worst;
  const ServoModels model = servo_models(task.machine.axes);
  RapidLag rapid(softest_gain_1_s(model));
  const auto seconds = run_model({.machine = task.machine,
                                  .path = task.path,
                                  .original = task.original,
                                  .map = task.map,
                                  .model = model,
                                  .others = {},
                                  .backlash_mm = backlash_mm(task.machine.axes),
                                  .unknown = task.unknown},
                                 [&](const ModelSample& sample) {
                                   const bool feed =
                                       task.path.segments[sample.segment].motion == Motion::feed;
                                   const double of_feed = rapid.of_feed_mm(sample, feed);
                                   const double error = std::abs(sample.error_mm) + sample.more_mm;
                                   if (!sample.cuts || error <= task.limit_mm) {
                                     return;
                                   }
                                   Peak& peak = worst[task.origin(sample.line)];
                                   if (error > peak.error_mm) {
                                     peak = {.line = task.origin(sample.line),
                                             .error_mm = error,
                                             .of_feed_mm = of_feed,
                                             .foot_mm = sample.foot_mm,
                                             .progress_mm = sample.progress_mm,
                                             .speed_mm_s = sample.command_mm_s,
                                             .segment = sample.segment};
                                   }
                                 });
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  std::vector<Peak> peaks;
  peaks.reserve(worst.size());
  for (const auto& [line, peak] : worst) {
    peaks.push_back(peak);
  }
  std::ranges::stable_sort(peaks, std::ranges::greater{}, &Peak::error_mm);
  return peaks;
}

std::optional<SharpCorner> corner_at(const OverTask& task, const Peak& peak) {
  namespace geometry = math::geometry;
  const auto& segments = task.original.segments;
  const auto [from, to] = stretch_of(peak);
  std::optional<SharpCorner> sharpest;
  for (std::size_t i = geometry::segment_at(segments, from); i + 1 < segments.size(); ++i) {
    const double at_mm = segments[i].position_mm + segments[i].length_mm;
    if (at_mm > to) {
      break;
    }
    if (at_mm < from || segments[i].motion != Motion::feed ||
        segments[i + 1].motion != Motion::feed) {
      continue;
    }
    const double cosine = geometry::dot(geometry::station_at(segments[i], 1.0).tangent,
                                        geometry::station_at(segments[i + 1], 0.0).tangent);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (angle >= kLeastAngle_rad && (!sharpest || angle > sharpest->angle_rad)) {
      sharpest = {.at_mm = at_mm, .angle_rad = angle, .line = segments[i].line};
    }
  }
  return sharpest;
}

bool by_rapid(const OverTask& task, const Peak& peak) noexcept {
  return peak.of_feed_mm <= task.limit_mm;
}

std::string reason_of(const OverTask& task, const Peak& peak) {
  std::string reason = by_rapid(task, peak)
                           ? std::string("the rapid before it: its lag runs into the cut")
                           : path_reason(task, peak);
  reason += block_words(task, peak);
  const std::string kept = task.kept(peak.line);
  return kept.empty() ? reason : fmt::format("{}; unchanged, because {}", reason, kept);
}

Result<std::vector<OverLine>> lines_over(const OverTask& task, std::size_t most_cured) {
  const auto peaks = peaks_over(task);
  if (!peaks) {
    return std::unexpected(peaks.error());
  }
  std::vector<OverLine> out;
  struct Cured {
    double from_mm = 0.0;
    double to_mm = 0.0;
    std::vector<Cure> cures;
  };
  std::vector<Cured> places;
  for (const Peak& peak : *peaks) {
    OverLine over{
        .line = peak.line, .error_mm = peak.error_mm, .reason = reason_of(task, peak), .cures = {}};
    const auto known = std::ranges::find_if(places, [&](const Cured& place) {
      return peak.foot_mm >= place.from_mm && peak.foot_mm <= place.to_mm;
    });
    if (known != places.end()) {
      over.cures = known->cures;
    } else if (places.size() < most_cured) {
      auto cures = cures_of(task, peak);
      if (!cures) {
        return std::unexpected(cures.error());
      }
      over.cures = *cures;
      const auto [from, to] = stretch_of(peak);
      places.push_back({from, to, std::move(*cures)});
    }
    out.push_back(std::move(over));
  }
  return out;
}

}  // namespace steadyrest::contour::offline
