// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// LinuxCNC: a word of the block acts only when the moves before it are done, so that the axes come
/// to rest there: S, a work offset other than the one in force, G92 and G52, G10 L2 and L20 of the
/// system in force, G43 and G49, M52 P1, M64, M65, M66, M68. Those that wait anyway (M3, M6, M8,
/// G4, M0 …) have events or moves of their own. Measured on 2.9.0~pre1: G10 of another system,
/// M48 to M51, M53, M62, M63, M67, T, G61, G64 and F do not wait. `state`: before the block.
[[nodiscard]] bool waits_for_rest(const Step& step, const State& state) noexcept;

}  // namespace steadyrest::nc::interpret
