// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>

/// From an override section of the machine file to the table of steps. Internal to the reader.
namespace steadyrest::passport {

/// False (and a fault) when steps and codes contradict each other.
bool make_override(const OverrideKeys& keys, const Given& given, Faults& faults,
                   kernel::machine::OverrideTable& out);

/// A machine file without [override.rapid]: the feed switch acts on rapids, never above 100 %.
[[nodiscard]] kernel::machine::OverrideTable rapid_from_feed(
    const kernel::machine::OverrideTable& feed);

/// A machine file without [override.spindle]: one step, 100 %.
[[nodiscard]] kernel::machine::OverrideTable without_override();

}  // namespace steadyrest::passport
