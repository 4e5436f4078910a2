// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/offline/predict/other_axes.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

constexpr double kOffTangent_mm = 1e-3;  ///< what a curve may leave its tangent by
constexpr double kBend = 0.995;          ///< cosine of a turn of 0.1 rad
constexpr double kReach = 1.5;           ///< of a tool's distance, that its foot may be away
constexpr int kBetween = 4;              ///< places of a tool in a sample near a bend

/// The path there is as good as its tangent for a tool so far along.
bool is_straight(const ModelFoot& foot, double along_mm) noexcept {
  const PathSegment& segment = foot.path[foot.at.foot_index];
  const double position_mm = foot.at.foot_position_mm + along_mm - segment.position_mm;
  return position_mm >= 0.0 && position_mm <= segment.length_mm &&
         foot.at.curvature_1_mm * along_mm * along_mm <= 2.0 * kOffTangent_mm;
}

bool has_bend_within(const ModelFoot& foot, double reach_mm) noexcept {
  const auto next = std::ranges::lower_bound(foot.bends_mm, foot.at.foot_position_mm - reach_mm);
  return next != foot.bends_mm.end() && *next <= foot.at.foot_position_mm + reach_mm;
}

}  // namespace

std::vector<double> bends_of(PathView path) {
  std::vector<double> out;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double turn = geometry::dot(geometry::station_at(path[i - 1], 1.0).tangent,
                                      geometry::station_at(path[i], 0.0).tangent);
    if (turn < kBend) {
      out.push_back(path[i].position_mm);
    }
  }
  return out;
}

OtherAxes::OtherAxes(const OtherModels& models, double period_s,
                     const std::array<double, 3>& backlash_mm) {
  for (std::size_t i = 0; models.size() > 0 && i < 3; ++i) {
    for (const online::AxisModel& model : models.axis[i]) {
      kinds_[i].push_back({.axis = {model, period_s, backlash_mm[i]}});
    }
  }
  errors_.resize(models.size());
}

void OtherAxes::step(const Point& command_mm, const Point& mean_mm_s,
                     const Point& change_mm_s) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (Kind& kind : kinds_[i]) {
      kind.before_mm = kind.axis.tool_mm();
      kind.axis.step(command_mm[i], mean_mm_s[i], change_mm_s[i]);
    }
  }
}

std::span<const OtherError> OtherAxes::errors(const ModelFoot& foot) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (Kind& kind : kinds_[i]) {
      const double off_mm = kind.axis.tool_mm() - foot.unknown_mm[i] - foot.at.foot_mm[i];
      kind.square_mm2 = off_mm * off_mm;
      kind.along_mm = off_mm * foot.at.tangent[i];
    }
  }
  auto out = errors_.begin();
  for (const Kind& x : kinds_[0]) {
    for (const Kind& y : kinds_[1]) {
      for (const Kind& z : kinds_[2]) {
        const double square_mm2 = x.square_mm2 + y.square_mm2 + z.square_mm2;
        const double along_mm = x.along_mm + y.along_mm + z.along_mm;
        const double error_mm = std::sqrt(std::max(0.0, square_mm2 - along_mm * along_mm));
        *out++ = is_straight(foot, along_mm)
                     ? OtherError{.error_mm = error_mm, .peak_mm = error_mm}
                     : exact(foot, {&x, &y, &z}, kReach * std::sqrt(square_mm2));
      }
    }
  }
  return errors_;
}

/// Near a bend the peak may be between two samples.
OtherError OtherAxes::exact(const ModelFoot& foot, const std::array<const Kind*, 3>& tool,
                            double reach_mm) noexcept {
  const auto distance_mm = [&](double share) {
    Point at_mm{};
    for (std::size_t i = 0; i < 3; ++i) {
      at_mm[i] = std::lerp(tool[i]->before_mm, tool[i]->axis.tool_mm(), share);
    }
    return geometry::distance_to(foot.path, geometry::subtract(at_mm, foot.unknown_mm),
                                 foot.at.foot_position_mm - reach_mm,
                                 foot.at.foot_position_mm + reach_mm);
  };
  OtherError out{.error_mm = distance_mm(1.0)};
  out.peak_mm = out.error_mm;
  if (has_bend_within(foot, reach_mm)) {
    for (int i = 1; i < kBetween; ++i) {
      out.peak_mm = std::max(out.peak_mm, distance_mm(static_cast<double>(i) / kBetween));
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
