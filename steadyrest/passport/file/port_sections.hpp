// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {

/// Reads the sections of ports from the root of a file, once the overrides are read. Absent:
/// nothing changes, unless `port` needs one.
void read_ports(const toml::table& root, kernel::machine::Machine& out, Faults& faults);

}  // namespace steadyrest::passport
