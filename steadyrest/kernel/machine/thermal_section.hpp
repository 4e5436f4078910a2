// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/section_reader.hpp>

namespace steadyrest::kernel::machine {

/// Reads `[thermal]` and the sections below it from the root of a file. Absent: nothing changes.
void read_thermal(const toml::table& root, Thermal& out, Faults& faults);

}  // namespace steadyrest::kernel::machine
