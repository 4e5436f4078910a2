// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/search/window_search.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// One search serves both cases: pieces of the program's path, or pieces of the commanded point's
// own trail. The window keeps it on the right turn (see the header); the search itself is in
// window_search.hpp.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::outcome::refuse;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

/// The program's path as pieces.
class PathPieces {
 public:
  explicit PathPieces(PathView path) noexcept : path_(path) {}
  [[nodiscard]] std::size_t size() const noexcept { return path_.size(); }
  [[nodiscard]] double begin_mm(std::size_t i) const noexcept { return path_[i].position_mm; }
  [[nodiscard]] double end_mm(std::size_t i) const noexcept {
    return path_[i].position_mm + path_[i].length_mm;
  }
  [[nodiscard]] const Point& start(std::size_t i) const noexcept { return path_[i].start_mm; }
  [[nodiscard]] const Point& end(std::size_t i) const noexcept { return path_[i].end_mm; }
  [[nodiscard]] Nearest foot(std::size_t i, const Point& query, double low, double high,
                             double guess) const noexcept {
    const PathSegment& segment = path_[i];
    const auto at = [&segment](double s) {
      return geometry::parameter_at(segment, s - segment.position_mm);
    };
    const geometry::Foot foot =
        geometry::foot_point(segment, query, low > begin_mm(i) ? at(low) : 0.0,
                             high < end_mm(i) ? at(high) : 1.0, at(guess));
    return {i,
            segment.position_mm + geometry::distance_at(segment, foot.u),
            foot.distance_mm,
            foot.u,
            foot.point_mm,
            true};
  }

 private:
  PathView path_;
};

/// The recent commanded points as pieces of a polyline, oldest first.
class TrailPieces {
 public:
  explicit TrailPieces(const ContourError::State& state) noexcept : state_(state) {}
  [[nodiscard]] std::size_t size() const noexcept { return state_.count - 1; }
  [[nodiscard]] double begin_mm(std::size_t i) const noexcept { return state_.at_mm[slot(i)]; }
  [[nodiscard]] double end_mm(std::size_t i) const noexcept { return state_.at_mm[slot(i + 1)]; }
  [[nodiscard]] const Point& start(std::size_t i) const noexcept {
    return state_.point_mm[slot(i)];
  }
  [[nodiscard]] const Point& end(std::size_t i) const noexcept {
    return state_.point_mm[slot(i + 1)];
  }
  [[nodiscard]] Nearest foot(std::size_t i, const Point& query, double /*low*/, double /*high*/,
                             double /*guess*/) const noexcept {
    const Point along = geometry::subtract(end(i), start(i));
    const double squared = geometry::norm_squared(along);
    const double u =
        squared > 0.0
            ? std::clamp(geometry::dot(geometry::subtract(query, start(i)), along) / squared, 0.0,
                         1.0)
            : 0.0;
    const Point point = geometry::add_scaled(start(i), along, u);
    return {i,
            begin_mm(i) + u * (end_mm(i) - begin_mm(i)),
            geometry::distance(point, query),
            u,
            point,
            true};
  }

 private:
  [[nodiscard]] std::size_t slot(std::size_t i) const noexcept {
    return (state_.next + ContourError::kHistory - state_.count + i) % ContourError::kHistory;
  }
  const ContourError::State& state_;
};

/// Direction of travel at the foot: at a joint the mean of both sides, since on the outside of a
/// corner the foot is on the corner itself and either leg alone would flip the sign.
Point direction_at(PathView path, const Nearest& foot, const geometry::Station& here) noexcept {
  constexpr double kJoint = 1e-9;  // mm, the accuracy of the foot
  const PathSegment& segment = path[foot.index];
  const double from_start = foot.position_mm - segment.position_mm;
  if (from_start <= kJoint && foot.index > 0) {
    return geometry::unit(
        geometry::add(here.tangent, geometry::station_at(path[foot.index - 1], 1.0).tangent));
  }
  if (segment.length_mm - from_start <= kJoint && foot.index + 1 < path.size()) {
    return geometry::unit(
        geometry::add(here.tangent, geometry::station_at(path[foot.index + 1], 0.0).tangent));
  }
  return here.tangent;
}

bool is_fit(const ContourError::Input& input) noexcept {
  return std::isfinite(input.time_s) && geometry::is_finite(input.command_mm) &&
         geometry::is_finite(input.actual_mm) && std::isfinite(input.path_position_mm) &&
         std::isfinite(input.path_speed_mm_s) &&
         (input.path.empty() || input.path_index < input.path.size());
}

/// The error at the foot with its signs: relative to the centre of curvature on arcs, to the
/// plane's left on lines. The distance comes from the search; only the signs come from here.
void measure(const Point& actual_mm, const Nearest& foot, const geometry::Station& here,
             const Point& plane_normal, ContourError::Output& output) noexcept {
  const Point offset = geometry::subtract(actual_mm, foot.point_mm);
  const double left = geometry::dot(offset, geometry::cross(plane_normal, here.tangent));
  const double inward = geometry::dot(offset, here.curvature_1_mm);
  output.valid = true;
  output.complete = foot.complete;
  output.left_mm = left < 0.0 ? -foot.distance_mm : foot.distance_mm;
  output.curvature_1_mm = geometry::norm(here.curvature_1_mm);
  output.error_mm = output.curvature_1_mm == 0.0 ? output.left_mm
                    : inward < 0.0               ? -foot.distance_mm
                                                 : foot.distance_mm;
  output.foot_mm = foot.point_mm;
  output.tangent = here.tangent;
  output.foot_index = foot.index;
  output.foot_position_mm = foot.position_mm;
}

}  // namespace

kernel::outcome::Result<ContourError> ContourError::make(const Config& config) {
  if (!(config.servo_gain_1_s >= 1.0 && config.servo_gain_1_s <= 1000.0)) {
    return refuse("the lowest servo gain is out of range; allowed: 1 … 1000 1/s",
                  "correct the axes' servo gain");
  }
  if (!(config.reserve_mm > 0.0 && config.reserve_mm <= 10.0)) {
    return refuse("the window's reserve is out of range; allowed: above 0 … 10 mm",
                  "correct the reserve");
  }
  if (!(std::abs(geometry::norm(config.plane_normal) - 1.0) < 1e-6)) {
    return refuse("the plane's normal has another length; allowed: 1", "give a unit vector");
  }
  return ContourError(config);
}

void ContourError::remember(const Input& input) noexcept {
  const std::size_t last = (state_.next + kHistory - 1) % kHistory;
  if (state_.count > 0) {
    const double step = geometry::distance(state_.point_mm[last], input.command_mm);
    if (step == 0.0) {
      return;  // standstill must not flush the trail
    }
    state_.travelled_mm += step;
  }
  state_.point_mm[state_.next] = input.command_mm;
  state_.at_mm[state_.next] = state_.travelled_mm;
  state_.next = (state_.next + 1) % kHistory;
  state_.count = std::min(state_.count + 1, kHistory);
}

/// Advances commanded point and lag to this sample; returns the time since the last one.
double ContourError::advance(const Input& input) noexcept {
  const bool has_path = !input.path.empty();
  const double elapsed_s =
      state_.started ? std::clamp(input.time_s - state_.time_s, 0.0, 1.0) : 0.0;
  // With and without a path the lengths count from different zeros, so the last foot is void.
  if (!state_.started || has_path != state_.from_path) {
    state_.lag_mm = input.path_speed_mm_s / config_.servo_gain_1_s;
    state_.foot_position_mm = -1.0;
    // A tool that was not seen in the cut may be on the rapid before it.
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    state_.cut_from_mm = state_.started && state_.tool_in_cut ? -kInfinite : kInfinite;
  }
  // ℓ' = v − k·ℓ, exactly over the step for constant v.
  const double decay = std::exp(-config_.servo_gain_1_s * elapsed_s);
  state_.lag_mm = state_.lag_mm * decay +
                  std::abs(input.path_speed_mm_s) / config_.servo_gain_1_s * (1.0 - decay);
  state_.started = true;
  state_.time_s = input.time_s;
  state_.from_path = has_path;
  remember(input);
  // The tool lags: when the cut begins it is still on the rapid. A program that begins again sets
  // the length back.
  const double commanded = has_path ? input.path_position_mm : state_.travelled_mm;
  state_.cut_from_mm = input.in_cut ? std::min(state_.cut_from_mm, commanded) : commanded;
  return elapsed_s;
}

/// Where the foot may be, given the servo lag, and where to look first.
ContourError::Window ContourError::window(const Input& input, double tracking_error_mm,
                                          double elapsed_s) const noexcept {
  const double reserve = config_.reserve_mm + input.slack_mm;
  const double back = std::max(2.5 * state_.lag_mm, 1.2 * tracking_error_mm) + reserve;
  const double ahead = 0.25 * tracking_error_mm + reserve;
  const double commanded = state_.from_path ? input.path_position_mm : state_.travelled_mm;
  Window out;
  out.low_mm = commanded - back;
  out.high_mm = commanded + ahead;
  out.knows_foot = state_.foot_position_mm >= out.low_mm && state_.foot_position_mm <= out.high_mm;
  out.guess_mm = out.knows_foot
                     ? state_.foot_position_mm + elapsed_s * std::abs(input.path_speed_mm_s)
                     : commanded - tracking_error_mm;
  return out;
}

ContourError::Output ContourError::update(const Input& input) noexcept {
  Output output;
  if (!is_fit(input)) {
    return output;
  }
  const double elapsed_s = advance(input);
  output.tracking_error_mm = geometry::distance(input.command_mm, input.actual_mm);
  const Window in = window(input, output.tracking_error_mm, elapsed_s);
  Nearest foot;
  geometry::Station here;
  if (state_.from_path) {
    // The last foot, or the command's own segment after a start.
    const std::size_t hint = in.knows_foot ? state_.foot_index : input.path_index;
    foot = nearest_in_window(PathPieces(input.path), input.actual_mm, in.low_mm, in.high_mm, hint,
                             in.guess_mm, kMaxFeet);
    here = geometry::station_at(input.path[foot.index], foot.u);
    here.tangent = direction_at(input.path, foot, here);
    output.from_path = true;
  } else {
    if (state_.count < 2) {
      return output;
    }
    const TrailPieces trail(state_);
    foot = nearest_in_window(trail, input.actual_mm, in.low_mm, in.high_mm, trail.size() - 1,
                             in.guess_mm, kMaxFeet);
    here.tangent =
        geometry::unit(geometry::subtract(trail.end(foot.index), trail.start(foot.index)));
  }
  state_.foot_position_mm = foot.position_mm;
  state_.foot_index = foot.index;
  measure(input.actual_mm, foot, here, config_.plane_normal, output);
  // A control may tell the cut before the path's place is in it.
  const bool on_cut = !state_.from_path || kernel::signal::in_cut(input.path[foot.index].motion);
  output.in_cut = input.in_cut && on_cut && foot.position_mm >= state_.cut_from_mm;
  state_.tool_in_cut = output.in_cut;
  return output;
}

ContourError::Output ContourError::update(const kernel::signal::Frame& frame) noexcept {
  return update(contour_input(frame));
}

ContourError::Input contour_input(const kernel::signal::Frame& frame) noexcept {
  ContourError::Input input;
  input.time_s = frame.time_s;
  for (std::size_t i = 0; i < 3; ++i) {
    input.command_mm[i] = frame.axis[i].command_mm;
    input.actual_mm[i] = frame.axis[i].actual_mm;
  }
  input.path = frame.path;
  input.path_index = frame.path_index;
  input.path_position_mm = frame.path_position_mm;
  input.path_speed_mm_s = frame.path_speed_mm_s;
  input.in_cut = kernel::signal::in_cut(frame.motion);
  return input;
}

ContourError::Input moved_to(ContourError::Input input, PathView path,
                             double position_mm) noexcept {
  input.path = path;
  input.path_position_mm = position_mm;
  input.path_index = geometry::segment_at(path, position_mm);
  const PathSegment& segment = path[input.path_index];
  input.command_mm = geometry::point_at(
      segment, geometry::parameter_at(segment, position_mm - segment.position_mm));
  return input;
}

// The places in between are interpolated, so the window is wider by what the command is off.
ContourError::Input original_input(const kernel::signal::Frame& frame) noexcept {
  const ContourError::Input own = contour_input(frame);
  if (frame.original.empty() || frame.path_index >= frame.path.size()) {
    return own;
  }
  const PathSegment& segment = frame.path[frame.path_index];
  const double share =
      segment.length_mm > 0.0
          ? std::clamp((frame.path_position_mm - segment.position_mm) / segment.length_mm, 0.0, 1.0)
          : 1.0;
  ContourError::Input input = moved_to(
      own, frame.original, std::lerp(segment.original_start_mm, segment.original_end_mm, share));
  input.slack_mm = geometry::distance(input.command_mm, own.command_mm);
  return input;
}

ContourError::Config contour_config(std::span<const kernel::machine::Axis> axes) noexcept {
  double softest_1_s = std::numeric_limits<double>::infinity();
  for (const kernel::machine::Axis& axis : axes.first(std::min<std::size_t>(3, axes.size()))) {
    softest_1_s = std::min(softest_1_s, axis.servo_gain_1_s);
  }
  ContourError::Config config;
  config.servo_gain_1_s = std::clamp(softest_1_s, 1.0, 1000.0);
  return config;
}

}  // namespace steadyrest::contour::online
