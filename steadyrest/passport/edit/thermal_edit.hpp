// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// The text of a machine file, or of a passport alone, with its thermal sections replaced by these;
/// at the end if it has none. Everything else stays byte for byte; comments inside the replaced
/// sections go. The result is read back before it is returned.
///
/// Refused: what the reader refuses, and thermal values not written as sections.
[[nodiscard]] kernel::outcome::Result<std::string> with_thermal(
    std::string_view text, const std::string& file, const kernel::machine::Thermal& thermal);

}  // namespace steadyrest::passport
