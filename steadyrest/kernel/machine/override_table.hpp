// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/schema.hpp>
#include <steadyrest/kernel/machine/section_reader.hpp>

/// From an override section of the machine file to the table of steps. Internal to the reader.
namespace steadyrest::kernel::machine {

/// False (and a fault) when steps and codes contradict each other.
bool make_override(const OverrideKeys& keys, const Given& given, Faults& faults,
                   OverrideTable& out);

/// A machine file without [override.rapid]: the feed switch acts on rapids, never above 100 %.
[[nodiscard]] OverrideTable rapid_from_feed(const OverrideTable& feed);

/// A machine file without [override.spindle]: one step, 100 %.
[[nodiscard]] OverrideTable without_override();

}  // namespace steadyrest::kernel::machine
