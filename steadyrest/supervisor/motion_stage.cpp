// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/motion/online/line/stored_lines.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>

// The kernel knows an axis as a sample with a count and one edge stamp; the motion room knows
// edges and ticks. This stage translates one into the other, axis by axis, and decides when a
// record has broken off.
namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Result;
using kernel::signal::AxisSample;
using motion::online::Estimate;
using motion::online::LineTable;
using motion::online::MotionEstimator;

constexpr double kGapCycles = 50.0;  ///< as MotionEstimator's
/// Times the axis's largest speed: overshoot stays below it, a counter that was set is far above.
constexpr double kImpossibleSpeed = 2.0;
/// Neighbouring counts beyond this cannot be told apart in mm.
constexpr double kFarthestCount = 1e12;
constexpr double kMostLost = 255.0;  ///< what the field holds
constexpr double kSigmas = 4.0;      ///< as MotionEstimator uses for a learnt σ
/// RMS error of a learnt table in counts, on ideal lines: motion/README.md, calibration.
constexpr double kFits = 0.004;

/// How far a line may be from its assumed position. With a table, what is left of the lines'
/// errors; without one, the machine file's bound. A table that does not cover the whole travel
/// leaves some lines at their raw error, shifted by the phases of the learnt lines.
double line_error_mm(const LineTable& lines, const kernel::machine::Axis& axis) {
  if (!lines.in_use()) {
    return axis.encoder.line_error_au;
  }
  const LineTable::Config& table = lines.config();
  std::int64_t from = table.first_line;
  std::int64_t to = from + static_cast<std::int64_t>(table.lines) - 1;
  if (!table.periodic) {  // the lines just before and after represent all that it lacks
    const double first = std::floor(axis.min_au / table.count_mm);
    const double last = std::ceil(axis.max_au / table.count_mm) + 1.0;
    from = static_cast<std::int64_t>(std::max(first, static_cast<double>(from - 1)));
    to = static_cast<std::int64_t>(std::min(last, static_cast<double>(to + 1)));
  }
  bool all_learnt = from <= to;
  double sigma_mm = 0.0;
  for (std::int64_t line = from; line <= to; ++line) {
    all_learnt = all_learnt && lines.learnt(line);
    sigma_mm = std::max(sigma_mm, static_cast<double>(lines.sigma_mm(line)));
  }
  double phase_mm = 0.0;
  for (const double error_mm : lines.phase_mm()) {
    phase_mm = std::max(phase_mm, std::abs(error_mm));
  }
  // The table's own error adds to the spread of what it did not learn, independent of it.
  const double left_mm = kSigmas * std::hypot(sigma_mm, kFits * table.count_mm);
  return all_learnt ? left_mm : std::max(axis.encoder.line_error_au + phase_mm, left_mm);
}

// An axis brakes harder than its drive pulls, since friction helps. So |a| ≤ drive + Coulomb (or
// breakaway) + viscous at full speed. No jerk limit: friction that reverses is a step of
// acceleration, and a bound based on a broken limit would be a lie.
MotionEstimator::Config config_of(const kernel::machine::Axis& axis, double cycle_s,
                                  double error_mm) {
  const kernel::machine::Friction& friction = axis.friction;
  const double drive_mm_s2 = std::isfinite(axis.drive_acceleration_au_s2)
                                 ? axis.drive_acceleration_au_s2
                                 : axis.max_acceleration_au_s2;
  const double braking_mm_s2 = std::max(friction.coulomb_au_s2, friction.breakaway_au_s2) +
                               friction.viscous_1_s * axis.max_speed_au_s;
  return {.count_mm = axis.encoder.count_au,
          .cycle_s = cycle_s,
          .clock_s = std::min(axis.encoder.clock_s, cycle_s),
          // A line that may be off by more than a count could be its neighbour: then no bound.
          .line_error_mm = error_mm <= axis.encoder.count_au ? error_mm : -1.0,
          .max_speed_mm_s = axis.max_speed_au_s,
          .max_acceleration_mm_s2 = drive_mm_s2 + braking_mm_s2,
          .max_jerk_mm_s3 = motion::online::kNoBound};
}

/// The counter rounds: it shows n from n − ½ to n + ½, so its line n is half a count below the
/// table's.
double line_mm(const LineTable& lines, std::int64_t line) noexcept {
  return lines.position_mm(line) - 0.5 * lines.config().count_mm;
}

}  // namespace

Result<MotionStage::Setup> MotionStage::setup(const kernel::machine::Axis& axis, double cycle_s) {
  auto lines = motion::online::stored_lines(axis.encoder);
  if (!lines) {
    return std::unexpected(std::move(lines.error()));
  }
  const MotionEstimator::Config limits = config_of(axis, cycle_s, line_error_mm(*lines, axis));
  return Setup{.lines = std::move(*lines), .limits = limits};
}

Result<MotionStage> MotionStage::make(const Config& config) {
  MotionStage stage;
  stage.gap_s_ = kGapCycles * config.cycle_s;
  for (std::size_t i = 0; i < std::min(config.axes.size(), kernel::signal::kMaxAxes); ++i) {
    const kernel::machine::Axis& axis = config.axes[i];
    if (!axis.present || !(axis.encoder.count_au > 0.0)) {
      continue;
    }
    auto made = setup(axis, config.cycle_s);
    if (!made) {
      return std::unexpected(std::move(made.error()));
    }
    const MotionEstimator::Config& limits = made->limits;
    auto estimator = MotionEstimator::make(limits);
    if (!estimator) {
      return std::unexpected(std::move(estimator.error()));
    }
    stage.axes_.push_back({.index = i,
                           .line_error_mm = std::max(limits.line_error_mm, 0.0),
                           .max_steps_s = kImpossibleSpeed * axis.max_speed_au_s / limits.count_mm,
                           .clock_s = limits.clock_s < limits.cycle_s ? limits.clock_s : 0.0,
                           .bounded = limits.line_error_mm >= 0.0,
                           .lines = std::move(made->lines),
                           .fresh = *estimator,
                           .now = {.estimator = *estimator}});
  }
  return stage;
}

// Copying the fresh estimator is bounded and takes no memory; making one would.
void MotionStage::restart(Axis& axis) const noexcept {
  if (axis.now.started) {
    axis.now.estimator = axis.fresh;
  }
  axis.now.estimate = {};
  axis.now.started = false;
}

MotionStage::State MotionStage::state() const {
  State state;
  for (const Axis& axis : axes_) {
    state.axis.push_back(axis.now);
  }
  return state;
}

// A state from another machine file has other axes: start over rather than mix them.
void MotionStage::restore(const State& state) noexcept {
  if (state.axis.size() != axes_.size()) {
    reset();
    return;
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].now = state.axis[i];
  }
}

void MotionStage::reset() noexcept {
  for (Axis& axis : axes_) {
    restart(axis);
  }
}

/// The record does not continue from where it was. Two counts of slack for the cell's borders;
/// beyond twice the axis's speed the counter was set.
bool MotionStage::broken(const Axis& axis, const AxisSample& sample, double time_s) const noexcept {
  const double passed_s = time_s - axis.now.time_s;
  const double steps = static_cast<double>(sample.count) - static_cast<double>(axis.now.count);
  return axis.now.started && (passed_s < 0.0 || passed_s > gap_s_ ||
                              std::abs(steps) > 2.0 + axis.max_steps_s * passed_s);
}

// A latching counter gives the present count and the time of the last edge. Of several edges in one
// cycle only the last is known; the others are reported as lost, and the cell at the tick still
// bounds the position.
void MotionStage::take_edge(Axis& axis, const AxisSample& sample, double time_s) const noexcept {
  const bool usable = axis.clock_s > 0.0 && std::isfinite(sample.edge_s) && sample.edge_s <= time_s;
  // A stamp truncated to the clock may lie just before the tick that it came after.
  const bool later = !axis.now.started || (sample.edge_s > axis.now.edge_s &&
                                           sample.edge_s >= axis.now.time_s - axis.clock_s);
  if (!usable || !later) {
    return;
  }
  axis.now.edge_s = sample.edge_s;
  const std::int64_t steps = axis.now.started ? sample.count - axis.now.count : 0;
  const int direction = sample.edge_direction != 0 ? sample.edge_direction
                        : steps > 0                ? 1
                        : steps < 0                ? -1
                                                   : 0;
  if (!axis.now.started || direction == 0) {
    return;
  }
  const bool up = direction > 0;
  // Up from n − 1 to n crosses line n; down from n + 1 to n crosses line n + 1.
  const std::int64_t line = up ? sample.count : sample.count + 1;
  const double others = std::abs(static_cast<double>(steps) - (up ? 1.0 : -1.0));
  // Never before the last tick: the estimator would refuse an edge in its past.
  axis.now.estimator.edge({.t_s = std::max(sample.edge_s, axis.now.time_s),
                           .position_mm = line_mm(axis.lines, line),
                           .line = line,
                           .direction = static_cast<std::int8_t>(up ? 1 : -1),
                           .lost = static_cast<std::uint8_t>(std::min(others, kMostLost)),
                           .sigma_mm = axis.lines.sigma_mm(line)});
}

/// Neither the edges nor the cell are more certain than the lines' positions.
void MotionStage::look(Axis& axis, const AxisSample& sample, double time_s) const noexcept {
  take_edge(axis, sample, time_s);
  axis.now.estimate = axis.now.estimator.tick(
      {.t_s = time_s,
       .count = sample.count,
       .low_mm = line_mm(axis.lines, sample.count) - axis.line_error_mm,
       .high_mm = line_mm(axis.lines, sample.count + 1) + axis.line_error_mm});
  axis.now.started = true;
  axis.now.time_s = time_s;
  axis.now.count = sample.count;
}

// First set all axes to "not known": no estimate from the port may pass for ours.
void MotionStage::update(kernel::signal::Frame& frame, bool fit) noexcept {
  for (AxisSample& sample : frame.axis) {
    sample.velocity_mm_s = 0.0;
    sample.acceleration_mm_s2 = 0.0;
    sample.velocity_bound_mm_s = motion::online::kNoBound;
    sample.acceleration_bound_mm_s2 = motion::online::kNoBound;
  }
  for (Axis& axis : axes_) {
    AxisSample& sample = frame.axis[axis.index];
    if (!fit || axis.index >= frame.axis_count || !std::isfinite(frame.time_s)) {
      continue;
    }
    // From 10¹² counts on, neighbouring counts look the same as a double in mm.
    if (!sample.encoder_shown || !(std::abs(static_cast<double>(sample.count)) < kFarthestCount)) {
      restart(axis);
      continue;
    }
    if (broken(axis, sample, frame.time_s)) {
      restart(axis);
    }
    if (!axis.now.started || frame.time_s > axis.now.time_s) {
      look(axis, sample, frame.time_s);
    }
    const Estimate& estimate = axis.now.estimate;
    // One NaN would stay in the filter's state for good.
    if (!std::isfinite(estimate.velocity_mm_s) || !std::isfinite(estimate.acceleration_mm_s2)) {
      restart(axis);
      continue;
    }
    sample.velocity_mm_s = estimate.velocity_mm_s;
    sample.acceleration_mm_s2 = estimate.acceleration_mm_s2;
    if (axis.bounded) {
      sample.velocity_bound_mm_s = estimate.velocity_bound_mm_s;
      sample.acceleration_bound_mm_s2 = estimate.acceleration_bound_mm_s2;
    }
  }
}

}  // namespace steadyrest::supervisor
