// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/machine/thermal.hpp>

namespace steadyrest::passport {

/// The sections `[thermal]` … of a machine file; read back they give the same values to nine
/// digits.
[[nodiscard]] std::string thermal_text(const kernel::machine::Thermal& thermal);

}  // namespace steadyrest::passport
