// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// Of a block as a whole.
[[nodiscard]] read::Refused at_block(const read::Block& block, std::string_view reason,
                                     std::string_view text, std::string_view word = {});
/// A comment that the control acts on has been reached; in doubt: with what was assumed of it.
[[nodiscard]] read::Refused acting_comment(const read::Block& block, bool in_doubt);
/// Adds a further finding, unless the report has one of its kind.
void add_kind(Report& report, const read::Refused& refused);

}  // namespace steadyrest::nc::interpret
