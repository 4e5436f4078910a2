// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// A file for the control.
struct ControlText {
  std::string name;
  std::string text;
};

/// The actions move axes: the machine file allows an offset and the mapping has one.
[[nodiscard]] bool has_offsets(const kernel::machine::Machine& machine) noexcept;

/// What the machine builder loads (folder control/), with this machine's numbers filled in: the
/// synchronized actions, the program that starts them, and the PLC block that takes their place
/// where the overrides must be masked by switch positions. Refused: a machine without [opcua],
/// names that the control does not have, more actions than there are numbers.
[[nodiscard]] kernel::outcome::Result<std::vector<ControlText>> control_texts(
    const kernel::machine::Machine& machine);

/// How long the control's side needs from the last heartbeat until the panel's feed alone is in
/// force, at most, when the layer held it at `from_ratio`: dead man + rise + two cycles. With the
/// PLC block: dead man + positions of the switch, one each `STEP_MS`, + two cycles of OB1, which
/// must not be longer than `STEP_MS`.
[[nodiscard]] double neutral_after_s(const kernel::machine::Machine& machine, double from_ratio,
                                     double panel_ratio = 1.0) noexcept;

/// The same from the lowest orders that the control takes to the switches' highest, feed and
/// spindle.
[[nodiscard]] double longest_hand_back_s(const kernel::machine::Machine& machine) noexcept;

}  // namespace steadyrest::adapters::opcua
