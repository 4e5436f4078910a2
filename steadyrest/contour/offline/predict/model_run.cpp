// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predict/other_axes.hpp>
#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/kernel/signal/arriving.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/nc/plan/time/spindle_clock.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;
using nc::plan::Setpoint;

constexpr double kJump = 1.5;  ///< of the tool's way, that its foot goes at a corner …
constexpr double kLeastJump_mm = 0.01;
constexpr double kSampleOfLag = 0.1;  ///< between two samples, in 1/k

class Runner {
 public:
  Runner(const ModelRun& run, online::ContourError contour)
      : run_(run),
        period_s_(run.machine.control.interpolator_period_s),
        every_(static_cast<std::size_t>(
            std::max(1.0, std::floor(kSampleOfLag / softest_gain_1_s(run.model) / period_s_)))),
        step_s_(period_s_ * static_cast<double>(every_)),
        arriving_(softest_gain_1_s(run.model)),
        contour_(contour),
        others_(run.others, step_s_, run.backlash_mm),
        bends_mm_(run.others.size() > 0 ? bends_of(run.original.segments) : std::vector<double>{}) {
    for (std::size_t i = 0; i < 3; ++i) {
      axes_.emplace_back(run.model[i], step_s_, run.backlash_mm[i]);
    }
  }

  void setpoint(const Setpoint& s, const std::function<void(const ModelSample&)>& on_sample) {
    const Point command = {s.position[0], s.position[1], s.position[2]};
    if (count_ == 0) {
      before_ = command;
    }
    ++count_;
    const Motion motion = arriving_.update(s.motion, time_s());
    line_ = arriving_.cuts_on() ? line_ : s.line;
    if (count_ % every_ != 0) {
      return;
    }
    const Point mean = geometry::scale(geometry::subtract(command, before_), 1.0 / step_s_);
    const Point change = geometry::subtract(mean, mean_);
    for (std::size_t i = 0; i < 3; ++i) {
      axes_[i].step(command[i], mean[i], change[i]);
    }
    others_.step(command, mean, change);
    before_ = command;
    mean_ = mean;
    sample(s, motion, command, on_sample);
  }
  /// The next setpoint's position is needed.
  [[nodiscard]] bool placed() const noexcept { return count_ == 0 || (count_ + 1) % every_ == 0; }
  /// The command has ended; the tool goes on until it has arrived.
  void arrive(const Setpoint& end, const std::function<void(const ModelSample&)>& on_sample) {
    do {
      setpoint(end, on_sample);
    } while (arriving_.cuts_on());
  }
  [[nodiscard]] double time_s() const noexcept { return static_cast<double>(count_) * period_s_; }

 private:
  void sample(const Setpoint& s, Motion motion, const Point& command,
              const std::function<void(const ModelSample&)>& on_sample) {
    const PathSegment& segment = run_.path.segments[s.path_index];
    const double share =
        segment.length_mm > 0.0
            ? std::clamp((s.path_position_mm - segment.position_mm) / segment.length_mm, 0.0, 1.0)
            : 0.0;
    const double start = run_.map.start_mm[s.path_index];
    progress_mm_ = start + share * (run_.map.end_mm[s.path_index] - start);
    const PathView original = run_.original.segments;
    const auto ends_before = [&](std::size_t i) {
      return i + 1 < original.size() &&
             original[i].position_mm + original[i].length_mm < progress_mm_;
    };
    while (ends_before(index_)) {
      ++index_;
    }
    while (index_ > 0 && original[index_].position_mm > progress_mm_) {
      --index_;
    }
    const Point tool = {axes_[0].tool_mm(), axes_[1].tool_mm(), axes_[2].tool_mm()};
    const auto error = contour_.update({.time_s = time_s(),
                                        .command_mm = command,
                                        .actual_mm = tool,
                                        .path = original,
                                        .path_index = index_,
                                        .path_position_mm = progress_mm_,
                                        .path_speed_mm_s = s.path_speed_mm_s});
    const double more = error.valid ? peak_mm(error, tool) - std::abs(error.error_mm) : 0.0;
    const Point unknown = run_.unknown ? run_.unknown(error.foot_position_mm) : Point{};
    if (error.valid) {
      const Point off = geometry::add(geometry::subtract(error.foot_mm, tool), unknown);
      on_sample(
          {.time_s = time_s(),
           .position_mm = s.path_position_mm,
           .command_mm_s = s.path_speed_mm_s,
           .progress_mm = progress_mm_,
           .foot_mm = error.foot_position_mm,
           .error_mm =
               run_.unknown ? std::copysign(geometry::norm(off), error.error_mm) : error.error_mm,
           .more_mm = more,
           .off_mm = off,
           .axes = {.servo = servo(), .mean_mm_s = mean_, .tool_mm = tool},
           .line = line_,
           .segment = s.path_index,
           .cuts = motion == Motion::feed && original[error.foot_index].motion == Motion::feed,
           .arriving = arriving_.cuts_on(),
           .ended = s.finished,
           .others = others_.errors(
               {.path = original, .at = error, .unknown_mm = unknown, .bends_mm = bends_mm_})});
    }
  }

  [[nodiscard]] online::ServoState servo() const noexcept {
    online::ServoState state;
    for (std::size_t i = 0; i < 3; ++i) {
      state.error_mm[i] = axes_[i].error_mm();
      state.velocity_mm_s[i] = axes_[i].velocity_mm_s();
    }
    return state;
  }

  /// The largest error since the sample before. At a corner it rises until the foot jumps to the
  /// other side, and falls from there: between two samples the peak would be missed.
  double peak_mm(const online::ContourError::Output& error, const Point& tool) noexcept {
    const double moved_mm = geometry::distance(tool, last_tool_mm_);
    double peak = std::abs(error.error_mm);
    if (last_foot_mm_ >= 0.0 &&
        std::abs(error.foot_position_mm - last_foot_mm_) > kJump * moved_mm + kLeastJump_mm) {
      const auto [low, high] = std::minmax(last_foot_mm_, error.foot_position_mm);
      for (std::size_t i = 1; i < every_; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(every_);
        const Point at =
            geometry::add_scaled(last_tool_mm_, geometry::subtract(tool, last_tool_mm_), share);
        peak = std::max(peak, geometry::distance_to(run_.original.segments, at, low, high));
      }
    }
    last_foot_mm_ = error.foot_position_mm;
    last_tool_mm_ = tool;
    return peak;
  }

  const ModelRun& run_;
  double period_s_;
  std::size_t every_;  ///< periods between two samples
  double step_s_;
  kernel::signal::Arriving arriving_;
  online::ContourError contour_;
  std::vector<ModelAxis> axes_;
  OtherAxes others_;
  std::vector<double> bends_mm_;
  std::size_t count_ = 0;
  std::size_t index_ = 0;  ///< segment of the original
  double progress_mm_ = 0.0;
  double last_foot_mm_ = -1.0;  ///< of the sample before; none yet
  Point last_tool_mm_{};
  std::uint32_t line_ = 0;
  Point before_{};
  Point mean_{};
};

}  // namespace

ServoModels servo_models(std::span<const kernel::machine::Axis> axes) {
  ServoModels models{};
  double stiffest = 0.0;
  for (const kernel::machine::Axis& axis : axes.first(std::min<std::size_t>(3, axes.size()))) {
    stiffest = std::max(stiffest, axis.servo_gain_1_s);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    models[i] = {.gain_1_s = stiffest > 0.0 ? stiffest : online::AxisModel{}.gain_1_s};
    if (i < axes.size()) {
      models[i] = {.gain_1_s = axes[i].servo_gain_1_s,
                   .feed_forward = axes[i].feed_forward,
                   .velocity_lag_s = axes[i].velocity_lag_s};
    }
  }
  return models;
}

std::array<double, 3> backlash_mm(std::span<const kernel::machine::Axis> axes) noexcept {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()); ++i) {
    out[i] = axes[i].backlash_au;
  }
  return out;
}

double softest_gain_1_s(const ServoModels& models) noexcept {
  return std::min({models[0].gain_1_s, models[1].gain_1_s, models[2].gain_1_s});
}

std::array<double, 3> first_lags_s(const ServoModels& models) noexcept {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (1.0 - models[i].feed_forward) / models[i].gain_1_s;
  }
  return out;
}

PathMap same_path(const nc::plan::PlannedPath& path) {
  PathMap map;
  map.start_mm.reserve(path.segments.size());
  map.end_mm.reserve(path.segments.size());
  for (const PathSegment& segment : path.segments) {
    map.start_mm.push_back(segment.position_mm);
    map.end_mm.push_back(segment.position_mm + segment.length_mm);
  }
  return map;
}

kernel::outcome::Result<double> run_model(
    const ModelRun& run, const std::function<void(const ModelSample&)>& on_sample) {
  if (run.path.segments.empty() || run.original.segments.empty()) {
    return 0.0;
  }
  auto interpolator = nc::plan::Interpolator::make(run.machine, nc::plan::whole(run.path));
  if (!interpolator) {
    return std::unexpected(interpolator.error());
  }
  online::ContourError::Config config;
  config.servo_gain_1_s = std::clamp(softest_gain_1_s(run.model), 1.0, 1000.0);
  auto contour = online::ContourError::make(config);
  if (!contour) {
    return std::unexpected(contour.error());
  }
  Runner runner(run, *contour);
  nc::plan::SpindleClock spindle(run.machine.spindle);
  for (;;) {
    const Setpoint s =
        interpolator->update({.spindle_actual_rev_s = spindle.speed_rev_s()}, runner.placed());
    if (s.finished) {
      const double seconds = runner.time_s();
      runner.arrive(s, on_sample);
      return seconds;
    }
    spindle.command(s.spindle_rev_s);
    spindle.advance(run.machine.control.interpolator_period_s);
    runner.setpoint(s, on_sample);
  }
}

}  // namespace steadyrest::contour::offline
