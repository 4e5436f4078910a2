// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/sim/machine_body.hpp>

// The machine's heat: how it grows, what the sensors and the probe read of it.
namespace steadyrest::sim {

using kernel::signal::Motion;

/// Heat of one period; the resulting displacement is in truth_.heat_mm.
void MachineBody::grow(const nc::plan::Setpoint& setpoint) noexcept {
  heating_.speed_rev_s += std::abs(spindle_now_.actual_rev_s);
  heating_.feed_mm_s += setpoint.path_speed_mm_s;
  heating_.cutting += kernel::signal::in_cut(setpoint.motion) ? 1.0 : 0.0;
  heating_.coolant = setpoint.coolant;
  if (++heating_periods_ < periods_of_growth_) {
    return;
  }
  const double share = 1.0 / heating_periods_;
  growth_->update({.speed_rev_s = heating_.speed_rev_s * share,
                   .feed_mm_s = heating_.feed_mm_s * share,
                   .cutting = heating_.cutting * share,
                   .coolant = heating_.coolant});
  heating_ = {};
  heating_periods_ = 0;
  read_sensors();
  for (std::size_t i = 0; i < grown_axis_.size(); ++i) {
    if (grown_axis_[i] < kernel::signal::kMaxAxes) {
      truth_.heat_mm[grown_axis_[i]] = growth_->displacement_mm(i);
    }
  }
}

void MachineBody::read_sensors() noexcept {
  for (std::size_t i = 0; i < sensors_; ++i) {
    temperature_c_[i] = growth_->read_room_c();
  }
}

// A probing move ends where the motion or the segment changes; its reading belongs to the axis that
// it moved furthest.
void MachineBody::probe(const nc::plan::Setpoint& setpoint) noexcept {
  const bool probed = setpoint_.motion == Motion::probe;
  const bool another =
      setpoint.motion != Motion::probe || setpoint.path_index != setpoint_.path_index;
  if (probed && another) {
    std::size_t furthest = grown_axis_.size();
    double travel_mm = 0.0;
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      const double by_mm = rotary_[i] ? 0.0 : std::abs(setpoint_.position[i] - probe_from_mm_[i]);
      if (by_mm > travel_mm) {
        travel_mm = by_mm;
        furthest =
            static_cast<std::size_t>(std::ranges::find(grown_axis_, i) - grown_axis_.begin());
      }
    }
    if (furthest < grown_axis_.size()) {
      const std::size_t axis = grown_axis_[furthest];
      reading_ = {
          .number = reading_.number + 1,
          .axis = static_cast<std::uint8_t>(axis),
          .displacement_mm = growth_->read_probe_mm(truth_.heat_mm[axis] + offset_mm_[axis]),
          .sd_mm = probe_noise_mm_};
    }
  }
  if (!probed || another) {
    probe_from_mm_ = setpoint_.position;
  }
}

}  // namespace steadyrest::sim
