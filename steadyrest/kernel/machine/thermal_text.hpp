// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/machine/thermal.hpp>

namespace steadyrest::kernel::machine {

/// The sections `[thermal]` … as a machine file has them; read back they give the same values to
/// nine digits.
[[nodiscard]] std::string thermal_text(const Thermal& thermal);

}  // namespace steadyrest::kernel::machine
