// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::outcome::unavailable;
using Got = SampleQueue::Got;

/// From the write to the command that contains it, beyond one: measured on 2.9.0~pre1.
constexpr double kOffsetCycles = 3.0;
constexpr double kPausesPerPeriod = 10.0;
/// Beats until an armed watchdog must show in the samples, and until a released one has seen it.
constexpr std::uint32_t kBeatsToShow = 30;
/// A path offset of 1.5 mm has ramped out by then; so long the watchdog stays released at most.
constexpr std::uint32_t kBeatsToRampOut = 300;
constexpr double kGone_mm = 0.002;
/// The HAL has risen to what is asked for by then, at the slowest.
constexpr std::uint32_t kBeatsToRise = 5000;
constexpr double kSameShare = 1e-6;

std::unexpected<Refusal> why(Got got) {
  switch (got) {
    case Got::frozen:
      return unavailable(
          "LinuxCNC's cycle counter does not change",
          "add layer.tick to the servo thread before the samplers, as layer.hal does");
    case Got::restarted:
      return unavailable("LinuxCNC's cycle counter went back", "start the layer again");
    case Got::not_a_tick:
      return unavailable("LinuxCNC's cycle counter is not a whole number",
                         "connect layer.tick to pin 0 of each sampler channel, as layer.hal does");
    default:
      return unavailable("no sample came from LinuxCNC's servo thread",
                         "see whether LinuxCNC runs and sampler.N.enable is 1");
  }
}

}  // namespace

Result<std::unique_ptr<LinuxCncPort>> LinuxCncPort::make(const Config& config, HalSide& hal) {
  const Units& units = config.units;
  if (!(units.servo_period_s > 0.0 && units.servo_period_s <= 0.1)) {
    return refuse("servo period unknown (allowed: above 0, up to 0.1 s)",
                  "give servo_period_ms; it is [EMCMOT] SERVO_PERIOD in the INI file");
  }
  if (units.axes < 1 || units.axes > kernel::signal::kMaxAxes) {
    return refuse("number of axes (allowed: 1 to 8)", "give the axes of the machine file");
  }
  if (!(units.linear_unit_mm > 0.0 && std::isfinite(units.linear_unit_mm))) {
    return refuse("linear unit (allowed: above 0 mm)",
                  "give 1 for [TRAJ] LINEAR_UNITS = mm, 25.4 for inch");
  }
  if (!(config.lost_after_s > units.servo_period_s && config.lost_after_s <= 10.0)) {
    return refuse("time without a sample (allowed: above the servo period, up to 10 s)",
                  "give about 0.1 s");
  }
  if (!(config.offset_slew_mm_s > 0.0 && std::isfinite(config.offset_slew_mm_s))) {
    return refuse("slew of the axis offsets (allowed: above 0 mm/s)",
                  "give [envelope] offset_slew_um_s");
  }
  return std::unique_ptr<LinuxCncPort>(new LinuxCncPort(config, hal));
}

/// Of X, Y and Z those that are known; in whole mm/s², as a record keeps it.
double LinuxCncPort::slowest_mm_s2(const Units& units,
                                   const kernel::signal::AxisValues& units_s2) noexcept {
  double slowest = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(units.axes, 3); ++i) {
    const double own = units.linear_unit_mm * units_s2[i];
    slowest = own > 0.0 && (slowest <= 0.0 || own < slowest) ? own : slowest;
  }
  return slowest > 0.0 ? std::max(1.0, std::floor(slowest)) : 0.0;
}

kernel::port::Capability LinuxCncPort::capability() const noexcept {
  return {.feed_override = true,
          .spindle_override = config_.spindle_connected,
          .axis_offset = offsets_connected_,
          .path_offset = offsets_connected_,
          .path_offset_delay_s = kOffsetCycles * config_.units.servo_period_s,
          .path_offset_acceleration_mm_s2 = slowest_offset_mm_s2_,
          .latched_word = true};
}

Result<kernel::signal::Frame> LinuxCncPort::read() noexcept {
  const auto pauses = static_cast<std::size_t>(
      std::ceil(kPausesPerPeriod * config_.lost_after_s / config_.units.servo_period_s));
  Got got = queue_.next(hal_, sample_);
  for (std::size_t i = 0; i < pauses && got == Got::none; ++i) {
    hal_.pause();
    got = queue_.next(hal_, sample_);
  }
  if (got != Got::sample) {
    return why(got);
  }
  std::size_t waiting = hal_.waiting(0);
  if (waiting > config_.most_waiting) {
    // Only what waits now: LinuxCNC goes on writing.
    remember_offsets();
    for (; waiting > 0 && queue_.next(hal_, sample_) == Got::sample; --waiting) {
      remember_offsets();
      ++skipped_;
    }
    waiting = hal_.waiting(0);
  } else {
    remember_offsets();
  }
  kernel::signal::Frame frame = frame_of(sample_, config_.units);
  const Inputs inputs = hal_.read_inputs();
  frame.temperature_c = inputs.temperature_c;
  frame.probe = inputs.probe;
  frame.probe.displacement_mm *= config_.units.linear_unit_mm;
  frame.vibration = inputs.vibration;
  frame.vibration_rate_hz = inputs.vibration_rate_hz;
  frame.age_s = static_cast<double>(waiting) * config_.units.servo_period_s;
  return frame;
}

/// LinuxCNC shows an offset two servo cycles before it is in the joint's command (measured on
/// 2.9.0~pre1): the frame has the one that its positions contain.
void LinuxCncPort::remember_offsets() noexcept {
  kernel::signal::AxisValues shown{};
  // After lost cycles the last one shown is all that is known.
  const bool follows = sample_.tick == offsets_tick_ + 1;
  offsets_tick_ = sample_.tick;
  for (std::size_t a = 0; a < shown.size(); ++a) {
    shown[a] = sample_.axis[a].offset;
    if (!follows) {
      offsets_[0][a] = offsets_[1][a] = shown[a];
    }
    sample_.axis[a].offset = offsets_[1][a];
  }
  offsets_[1] = offsets_[0];
  offsets_[0] = shown;
}

/// Nothing but the offset against heat is in force.
bool LinuxCncPort::path_offset_gone() const noexcept {
  for (std::size_t a = 0; offsets_connected_ && a < config_.units.axes; ++a) {
    if (std::abs(offsets_[0][a] - heat_offset_[a]) * config_.units.linear_unit_mm > kGone_mm) {
      return false;
    }
  }
  return true;
}

/// The HAL lets through what is asked for.
bool LinuxCncPort::feed_risen() const noexcept {
  return sample_[Column::layer_feed] >=
         feed_share(pins_.feed, sample_[Column::feed_panel]) - kSameShare;
}

void LinuxCncPort::arm() noexcept {
  ++beats_;
  if (!pins_.armed) {
    // Let the servo thread see the released state before the next rising edge, and let the path
    // offset of an earlier layer ramp out there: once armed, it would jump to this one's. A feed
    // that returns there does so by the slow rate, which ends with the arming.
    if (beats_ > kBeatsToShow / 10 && (path_offset_gone() || beats_ > kBeatsToRampOut) &&
        (feed_risen() || beats_ > kBeatsToRise)) {
      pins_.armed = true;
      beats_ = 0;
    }
  } else if (!in_force() && beats_ > kBeatsToShow) {
    pins_.armed = false;
    beats_ = 0;
    ++rearmed_;
  }
}

Result<void> LinuxCncPort::write(const kernel::signal::Command& command) noexcept {
  if (!command.write) {
    return refuse("a command that must not be written", "write in the mode act only");
  }
  pins_ = pins_of(command, sample_, config_.units, pins_);
  if (!offsets_connected_) {
    pins_.offset.fill(0.0);
    pins_.path_offset.fill(0.0);
  }
  pins_.heartbeat = !pins_.heartbeat;
  arm();
  Pins given = pins_;
  if (!in_force()) {
    given.path_offset.fill(0.0);  // it begins when the servo thread lets it in
  }
  course_.apply(given, sample_[Column::enabled] != 0.0, sample_.tick, config_.units.servo_period_s);
  heat_offset_ = given.offset;
  hal_.write_pins(given);
  return {};
}

}  // namespace steadyrest::adapters::linuxcnc
