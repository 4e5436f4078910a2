// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {

/// Reads `[program.words]`: what the machine builder's words do. Keys are words as programs have
/// them (`M50`, `L_TIME`), whatever their case; values are `none`, `stop`, `dwell 0.5` (seconds),
/// `moves X Z` and `opaque`.
void read_words(const toml::table& table, std::vector<kernel::machine::BuildersWord>& out,
                Faults& faults);

}  // namespace steadyrest::passport
