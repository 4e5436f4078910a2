// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live::test {

/// The chatter room modulates in every cut; Z has a thermal model.
inline kernel::machine::Machine with_rooms(kernel::machine::Machine machine) {
  machine.chatter.enabled = true;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  machine.thermal.enabled = true;
  kernel::machine::ThermalAxis z;
  z.name = "Z";
  z.mode.emplace_back();
  z.mode[0].tau_s = 600.0;
  z.mode[0].speed_rev_s = {0.0, 100.0};
  z.mode[0].level_mm = {0.0, 0.010};
  machine.thermal.axis = {z};
  return machine;
}

/// A new layer with both rooms on.
inline void switch_rooms_on(Desk& desk) {
  desk.machine = with_rooms(desk.machine);
  desk.layer.emplace(supervisor::Supervisor::make(desk.machine, desk.port->capability()).value());
}

/// The desk with both rooms on.
struct RoomsDesk : Desk {
  RoomsDesk() { switch_rooms_on(*this); }
};

}  // namespace steadyrest::live::test
