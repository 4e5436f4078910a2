// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/adapters/opcua/wire.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// What is wrong with the control's nodes, from the bridge's answer to `check`: unknown names,
/// wrong types, arrays that are too short, nodes that this user may not read or write.
[[nodiscard]] std::vector<kernel::outcome::Refusal> node_faults(
    const Answer& answer, const NodePlan& plan, const kernel::machine::OpcUa& config);

/// Shown overrides that cannot be, by a wrong node or scale: all lie within 0 … 200 %, or what the
/// machine's table has.
[[nodiscard]] std::vector<kernel::outcome::Refusal> override_faults(
    const Reading& reading, const kernel::machine::Machine& machine);
/// Positions more than 1 mm beyond the travel, in another unit or of an axis that is not
/// referenced.
[[nodiscard]] std::vector<kernel::outcome::Refusal> position_faults(
    const Reading& reading, const kernel::machine::Machine& machine);

/// A number of the G code that G group 1 does not have: the control does not tell the group.
[[nodiscard]] std::optional<kernel::outcome::Refusal> motion_fault(
    const Reading& reading, const kernel::machine::OpcUa& config);

}  // namespace steadyrest::adapters::opcua
