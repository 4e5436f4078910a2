// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {

/// Reads [opcua] and the mapping file that it names, once the axes are read. Absent: nothing
/// changes, unless `port` needs it.
void read_opcua(const toml::table& root, kernel::machine::Machine& out, Faults& faults);

/// Reads the text of a mapping into `out`, whose keys of the machine file are read; `faults` has
/// the mapping's name.
void read_mapping(std::string_view text, const kernel::machine::Machine& machine,
                  kernel::machine::OpcUa& out, Faults& faults);

}  // namespace steadyrest::passport
