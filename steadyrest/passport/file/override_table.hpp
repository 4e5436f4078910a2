// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>

/// From an override section of the machine file to the table of steps. Internal to the reader.
namespace steadyrest::passport {

/// Reads `[override.feed]`, `[override.rapid]` and `[override.spindle]` from the root of a file.
/// Without [override.rapid] the feed switch acts on rapids, never above 100 %; without
/// [override.spindle] there is one step, 100 %.
void read_overrides(const toml::table& root, kernel::machine::Machine& out, Faults& faults);

}  // namespace steadyrest::passport
