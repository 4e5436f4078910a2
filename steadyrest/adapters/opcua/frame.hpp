// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::adapters::opcua {

/// G codes of group 1: `motion_number` is 1 to this.
constexpr std::size_t kGroup1Codes = 21;

/// Which optional quantities the mapping has; a missing one gets what is stated.
struct Mapped {
  bool feed_effective = false;   ///< else the panel's
  bool rapid = false;            ///< else 100 %
  bool spindle = false;          ///< else 100 %
  bool following_error = false;  ///< else command − actual
  bool motion = false;           ///< else feed while a program runs
  bool program_state = false;    ///< else unknown
  bool programmed_feed = false;  ///< else path speed / effective override
  bool spindle_speeds = false;   ///< else 0
};
[[nodiscard]] Mapped mapped(const kernel::machine::OpcUa& config) noexcept;

/// By the words of the mapping.
[[nodiscard]] kernel::signal::ProgramState program_state(
    const Reading& reading, const kernel::machine::OpcUa& config) noexcept;

/// Everything but time, age and cycle. What is mapped and not known stays NaN: the supervisor
/// answers with neutral requests.
[[nodiscard]] kernel::signal::Frame frame_of(const Reading& reading, const Mapped& mapped,
                                             const kernel::machine::Machine& machine,
                                             const kernel::override::Table* feed_table) noexcept;

/// A command as an order; a value that is not finite asks for nothing.
[[nodiscard]] Order order_of(const kernel::signal::Command& command,
                             const kernel::machine::Machine& machine) noexcept;

}  // namespace steadyrest::adapters::opcua
