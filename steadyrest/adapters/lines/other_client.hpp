// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/machine/lines.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Two layers on one module would flip its words for ever: the second one must not begin.
namespace steadyrest::adapters::lines {

/// Who else has the outputs, as far as they show it: outputs that change while this program writes
/// nothing (the heartbeat; with `through` the word, though the panel does not turn). Without a
/// heartbeat a mask that stays on is a layer too, once the module's watchdog would have dropped a
/// dead one's. Watches for four cycles, 0.3 s at least; then also for twice the watchdog's time.
/// Outputs that all go off are a watchdog's. Empty: nobody. Refused: the link.
[[nodiscard]] kernel::outcome::Result<std::string> other_client(
    Wires& wires, const kernel::machine::Lines& lines);

}  // namespace steadyrest::adapters::lines
