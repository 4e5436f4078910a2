// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/online/offset_governor.hpp>

// A frame passes through drive_on() (time, heat and sensors to the filters), probe() (a reading,
// once), and ask() (the wish and its slope for each axis). Filters step once a second, or when the
// kind of work changes, not in every cycle: the fastest heat here has a time constant of minutes.
namespace steadyrest::thermal::online {

namespace machine = kernel::machine;
using kernel::outcome::Reason;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Frame;
using kernel::signal::InForce;
using kernel::signal::Motion;

namespace {

/// The filters are updated at least this often. For a mode with τ = 1 min a one-second mean instead
/// of the true course is off by 1/(2·60) of the level's change within that second.
constexpr double kHold_s = 1.0;
/// Anything slower is the noise of a stationary encoder: 0.6 rpm, one count of 1024 in 0.1 s.
constexpr double kStandstill_rev_s = 0.01;
/// What happened in longer gaps is unknown: a restart or a lost link, not a pause between blocks.
/// Test AGapBelowAMinuteIsNone.
constexpr double kGap_s = 60.0;
/// Of the fastest fitted speed: with heat as n^1.5 a fifth more speed is a third more heat, as far
/// as the levels may be extrapolated. Test HoldsAboveTheSpeedsThatWereFitted.
constexpr double kBeyondSpeed = 1.2;
constexpr double kThere_mm = 1e-4;  ///< closer to the wish counts as there: a control's finest step

OffsetGovernor::Running running_of(const Frame& frame) noexcept {
  OffsetGovernor::Running drive;
  const double speed = std::abs(frame.spindle_actual_rev_s);
  drive.speed_rev_s = speed < kStandstill_rev_s ? 0.0 : speed;
  drive.feed_mm_s = frame.path_speed_mm_s;
  drive.cutting = kernel::signal::in_cut(frame.motion);
  drive.coolant = frame.coolant;
  return drive;
}

// A mean over both classes would match neither: levels switch with cutting, coolant and standstill.
bool same_class(const OffsetGovernor::Running& a, const OffsetGovernor::Running& b) noexcept {
  return a.cutting == b.cutting && a.coolant == b.coolant &&
         (a.speed_rev_s == 0.0) == (b.speed_rev_s == 0.0);
}

bool must_hold(Motion motion) noexcept {
  return kernel::signal::is_locked(motion) || motion == Motion::probe;
}

/// The worse a reason, the more it must be shown. The page shows one reason for all axes. A model
/// that no longer fits outranks a sensor, because the correction itself is in doubt.
int weight(Reason reason) noexcept {
  switch (reason) {
    case Reason::thermal_model_unfit:
      return 8;
    case Reason::thermal_sensor_wild:
      return 7;
    case Reason::thermal_sensor_stuck:
      return 6;
    case Reason::thermal_sensor_lost:
      return 5;
    case Reason::thermal_beyond_speed:
    case Reason::thermal_in_text:
      return 4;
    case Reason::thermal_clamped:
      return 3;
    case Reason::thermal_held:
      return 2;
    case Reason::thermal_following:
      return 1;
    default:
      return 0;
  }
}

std::unexpected<Refusal> too_many_sensors(std::size_t count) {
  return refuse("the thermal passport names " + std::to_string(count) + " temperature sensors",
                "use at most " + std::to_string(kernel::signal::kMaxTemperatures) + " on line");
}

}  // namespace

Result<OffsetGovernor> OffsetGovernor::make(const Config& config) {
  const machine::Thermal& thermal = config.thermal;
  const auto sensors = thermal.sensors();
  if (sensors.size() > kernel::signal::kMaxTemperatures) {
    return too_many_sensors(sensors.size());
  }
  OffsetGovernor made;
  made.max_offset_mm_ = std::min(thermal.max_offset_mm, config.max_offset_mm);
  made.slope_mm_s_ = thermal.slope_mm_s;
  made.retract_slope_mm_s_ = std::max(thermal.retract_slope_mm_s, thermal.slope_mm_s);
  made.sensors_ = sensors.size();
  const std::size_t axes = std::min(config.axes.size(), kernel::signal::kMaxAxes);
  for (std::size_t i = 0; i < axes; ++i) {
    const auto of =
        std::ranges::find(thermal.axis, config.axes[i].name, &machine::ThermalAxis::name);
    // Offsets are lengths; a displacement that belongs to no machine axis is only forecast.
    if (of == thermal.axis.end() || config.axes[i].rotary) {
      continue;
    }
    StateFilter::Config model;
    model.axis = *of;
    model.max_bias_mm = std::max(made.max_offset_mm_, 0.001);
    auto filter = StateFilter::make(model);
    if (!filter) {
      return std::unexpected(std::move(filter.error()));
    }
    Axis axis{.index = i,
              .max_speed_rev_s = of->max_speed_rev_s,
              .ambients = of->ambient.size(),
              .sensor = {},
              .filter = std::move(*filter)};
    for (std::size_t j = 0; j < axis.ambients; ++j) {
      axis.sensor[j] = static_cast<std::size_t>(std::ranges::find(sensors, of->ambient[j].sensor) -
                                                sensors.begin());
    }
    made.axes_.push_back(std::move(axis));
  }
  return made;
}

void OffsetGovernor::step(double elapsed_s, const Running& running) noexcept {
  drive_.speed_rev_s = running.speed_rev_s;
  drive_.feed_mm_s = running.feed_mm_s;
  drive_.cutting = running.cutting;
  drive_.coolant = running.coolant;
  Fed& fed = state_.last.fed;
  fed.time_s += elapsed_s;
  fed.turned_rev += elapsed_s * running.speed_rev_s;
  fed.path_mm += elapsed_s * running.feed_mm_s;
  fed.cut_s += running.cutting ? elapsed_s : 0.0;
  fed.coolant_s += running.coolant ? elapsed_s : 0.0;
  for (Axis& axis : axes_) {
    for (std::size_t j = 0; j < axis.ambients; ++j) {
      drive_.ambient_c[j] = state_.temperature_c[axis.sensor[j]];
    }
    axis.filter.update(elapsed_s, drive_);
  }
}

/// Passes the pending time to the filters.
void OffsetGovernor::step() noexcept {
  if (state_.pending_s > 0.0) {
    Running mean = state_.drive;
    // Mean over the pending time: levels depend on the speed, which may change in every cycle
    // between two updates.
    mean.speed_rev_s = state_.turned_rev / state_.pending_s;
    mean.feed_mm_s = state_.path_mm / state_.pending_s;
    step(state_.pending_s, mean);
  }
  state_.pending_s = 0.0;
  state_.turned_rev = 0.0;
  state_.path_mm = 0.0;
}

/// A frame's drive applies from its time to the next frame's.
void OffsetGovernor::drive_on(const Frame& frame) noexcept {
  const double elapsed_s = state_.started ? std::max(0.0, frame.time_s - state_.time_s) : 0.0;
  state_.time_s = frame.time_s;
  const Running drive = running_of(frame);
  const bool first = !state_.started;
  state_.started = true;
  state_.unwatched_s += elapsed_s;
  if (elapsed_s > kGap_s) {
    step();
    // What happened is unknown: counted as standstill.
    step(elapsed_s, {});
  } else {
    state_.pending_s += elapsed_s;
    state_.turned_rev += elapsed_s * state_.drive.speed_rev_s;
    state_.path_mm += elapsed_s * state_.drive.feed_mm_s;
  }
  // A change between cutting and air, of coolant or of standstill ends the pending time, since
  // these enter as states and have no mean.
  if (first || elapsed_s > kGap_s || state_.pending_s >= kHold_s ||
      !same_class(state_.drive, drive)) {
    step();
    state_.temperature_c = frame.temperature_c;
    watch_.update(state_.unwatched_s, sensors_, state_.temperature_c);
    state_.unwatched_s = 0.0;
  }
  if (first) {
    step(0.0, drive);  // the first temperatures count as settled
  }
  state_.drive = drive;
}

Reason OffsetGovernor::fault(const Axis& axis, const Frame& frame) const noexcept {
  if (const Reason unfit = axis.filter.fault(); unfit != Reason::none) {
    return unfit;
  }
  for (std::size_t j = 0; j < axis.ambients; ++j) {
    if (!std::isfinite(frame.temperature_c[axis.sensor[j]])) {
      return Reason::thermal_sensor_lost;
    }
    if (const Reason doubted = watch_.fault(axis.sensor[j]); doubted != Reason::none) {
      return doubted;
    }
  }
  const bool beyond = axis.max_speed_rev_s > 0.0 &&
                      std::abs(frame.spindle_actual_rev_s) > kBeyondSpeed * axis.max_speed_rev_s;
  if (beyond) {
    return Reason::thermal_beyond_speed;
  }
  return frame.heat_in_text ? Reason::thermal_in_text : Reason::none;
}

/// A fade keeps to the slower slope: a sensor that fails for a second must not remove all of the
/// offset.
Reason OffsetGovernor::ask(const Axis& axis, const Frame& frame, bool tool_in_cut,
                           double let_through_mm) noexcept {
  double& wish = state_.last.request.offset_mm[axis.index];
  double& slope_mm_s = state_.last.request.slope_mm_s[axis.index];
  const Reason faulty = fault(axis, frame);
  // A thread is cut in several passes on one lead, and a probing move measures with the offset that
  // it began with; a step in the cut marks the part. Slope 0 freezes all three.
  if (must_hold(frame.motion) || (faulty != Reason::none && tool_in_cut)) {
    slope_mm_s = 0.0;
    return faulty != Reason::none ? faulty : Reason::thermal_held;
  }
  const double whole = axis.reference_mm - axis.filter.displacement_mm();
  const double within = std::clamp(whole, -max_offset_mm_, max_offset_mm_);
  // The wish jumps to 0 on a fault; the slope makes a fade of it.
  wish = faulty == Reason::none ? within : 0.0;
  const bool slowly = tool_in_cut || kernel::signal::in_cut(frame.motion) || faulty != Reason::none;
  slope_mm_s = slowly ? slope_mm_s_ : retract_slope_mm_s_;
  if (faulty != Reason::none) {
    return faulty;
  }
  if (within != whole) {
    return Reason::thermal_clamped;
  }
  return std::abs(wish - let_through_mm) > kThere_mm ? Reason::thermal_following
                                                     : Reason::thermal_correcting;
}

/// The frame's reading, if its number is new.
void OffsetGovernor::probe(const Frame& frame) noexcept {
  // The first frame after a start may show an old reading, made with an unknown offset.
  const bool fresh = probe_watched_ && frame.probe.number != probe_number_;
  probe_watched_ = true;
  probe_number_ = frame.probe.number;
  if (!fresh || frame.probe.number == 0) {
    return;
  }
  state_.last.probed = {.reading = frame.probe, .verdict = {}};
  if (frame.probe.axis >= frame.axis_count) {
    state_.last.probed.verdict.reason = Reason::input_out_of_range;
    return;
  }
  state_.last.probed.verdict =
      measure(frame.probe.axis,
              {.displacement_mm = frame.probe.displacement_mm, .sd_mm = frame.probe.sd_mm});
}

// Unfit frames leave wish and slope unchanged; the envelope knows the reason and acts on it.
const OffsetGovernor::Output& OffsetGovernor::update(const Frame& frame, Reason unfit,
                                                     bool tool_in_cut,
                                                     const InForce& in_force) noexcept {
  state_.last.request.tool_in_cut = tool_in_cut;
  for (Axis& axis : axes_) {
    // On the machine, not requested: in observe and advise no offset is there.
    axis.applied_mm = in_force.written ? in_force.offset_mm[axis.index] : 0.0;
  }
  if (unfit != Reason::none || !std::isfinite(frame.time_s)) {
    state_.last.request.reason = unfit != Reason::none ? unfit : Reason::input_not_finite;
    return state_.last;
  }
  drive_on(frame);
  probe(frame);
  state_.last.request.reason = axes_.empty() ? Reason::none : Reason::thermal_correcting;
  for (const Axis& axis : axes_) {
    const Reason reason = ask(axis, frame, tool_in_cut, in_force.offset_mm[axis.index]);
    if (weight(reason) > weight(state_.last.request.reason)) {
      state_.last.request.reason = reason;
    }
    state_.last.displacement_mm[axis.index] = axis.filter.displacement_mm();
    state_.last.sd_mm[axis.index] = axis.filter.sd_mm();
  }
  return state_.last;
}

void OffsetGovernor::zero_here() noexcept {
  step();
  for (Axis& axis : axes_) {
    // r = δ + the offset on the machine, so the wish r − δ equals the present offset and nothing
    // moves.
    axis.reference_mm = axis.filter.displacement_mm() + axis.applied_mm;
  }
}

OffsetGovernor::Axis* OffsetGovernor::find(std::size_t axis) noexcept {
  const auto found = std::ranges::find(axes_, axis, &Axis::index);
  return found == axes_.end() ? nullptr : &*found;
}

StateFilter::Verdict OffsetGovernor::measure(std::size_t axis,
                                             const StateFilter::Reading& reading) noexcept {
  Axis* of = find(axis);
  if (of == nullptr) {
    return {};
  }
  step();
  // The probe finds e = δ + offset − r, so in the model's terms δ = e + r − offset.
  return of->filter.measure(
      {.displacement_mm = reading.displacement_mm + of->reference_mm - of->applied_mm,
       .sd_mm = reading.sd_mm});
}

void OffsetGovernor::rezero(std::size_t axis, const StateFilter::Reading& reading) noexcept {
  if (Axis* of = find(axis); of != nullptr) {
    step();
    of->filter.rezero(
        {.displacement_mm = reading.displacement_mm + of->reference_mm - of->applied_mm,
         .sd_mm = reading.sd_mm});
  }
}

OffsetGovernor::State OffsetGovernor::state() const noexcept {
  State state = state_;
  state.sensors = watch_.state();
  for (const Axis& axis : axes_) {
    state.axis[axis.index] = {.filter = axis.filter.state(),
                              .reference_mm = axis.reference_mm,
                              .applied_mm = axis.applied_mm};
  }
  return state;
}

void OffsetGovernor::restore(const State& state) noexcept {
  reset();
  const bool fit = std::isfinite(state.pending_s) && state.pending_s >= 0.0 &&
                   std::isfinite(state.turned_rev) && std::isfinite(state.path_mm) &&
                   std::isfinite(state.time_s) && std::isfinite(state.unwatched_s) &&
                   std::isfinite(state.drive.speed_rev_s) && std::isfinite(state.drive.feed_mm_s);
  if (fit) {
    state_ = state;
    watch_.restore(state.sensors);
  }
  for (Axis& axis : axes_) {
    const AxisState& of = state.axis[axis.index];
    if (std::isfinite(of.reference_mm)) {
      axis.filter.restore(of.filter);
      axis.reference_mm = of.reference_mm;
    }
    axis.applied_mm = std::isfinite(of.applied_mm) ? of.applied_mm : 0.0;
    double& wish = state_.last.request.offset_mm[axis.index];
    wish = std::isfinite(wish) ? std::clamp(wish, -max_offset_mm_, max_offset_mm_) : 0.0;
  }
}

void OffsetGovernor::reset() noexcept {
  state_ = {};
  watch_.reset();
  probe_number_ = 0;
  probe_watched_ = false;
  for (Axis& axis : axes_) {
    axis.filter.reset();
    axis.reference_mm = 0.0;
    axis.applied_mm = 0.0;
  }
}

}  // namespace steadyrest::thermal::online
