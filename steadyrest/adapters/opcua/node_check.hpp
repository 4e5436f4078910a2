// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Shown values that cannot be: a wrong node, unit or scale. Overrides lie within 0 … 200 % (or
/// what the machine's table has), positions within the travel and 1 mm.
[[nodiscard]] std::vector<kernel::outcome::Refusal> value_faults(
    const Reading& reading, const kernel::machine::Machine& machine);

}  // namespace steadyrest::adapters::opcua
