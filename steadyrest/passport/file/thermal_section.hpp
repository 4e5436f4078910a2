// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {

/// Reads `[thermal]` and the sections below it from the root of a file. Absent: nothing changes.
void read_thermal(const toml::table& root, kernel::machine::Thermal& out, Faults& faults);

}  // namespace steadyrest::passport
