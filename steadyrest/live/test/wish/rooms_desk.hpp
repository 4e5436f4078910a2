// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/testing/warm_axis.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live::test {

/// The chatter room modulates in every cut; Z has a thermal model.
inline kernel::machine::Machine with_rooms(kernel::machine::Machine machine) {
  machine.chatter.enabled = true;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  machine.thermal.enabled = true;
  machine.thermal.axis = {kernel::testing::warm_z()};
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
