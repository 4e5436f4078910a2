// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Two layers on one module would flip its words for ever: the second one must not begin.
namespace steadyrest::adapters::lines {

/// Who else has the outputs, as far as they show it: a heartbeat that changes while this program
/// writes nothing; without one any output, and a mask that stays on once the module's watchdog
/// would have dropped a dead layer's. What a watchdog drops is excused, and with `through` what
/// follows a panel that turns. Watches for four cycles, 0.3 s at least, or twice the watchdog's
/// time; `pause`: between two readings, some milliseconds. Empty: nobody. Refused: the link.
[[nodiscard]] kernel::outcome::Result<std::string> other_client(Wires& wires,
                                                                const kernel::machine::Lines& lines,
                                                                const std::function<void()>& pause);

}  // namespace steadyrest::adapters::lines
