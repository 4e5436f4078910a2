// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Universal file format, dataset 58 (function at nodal degree of freedom) as text: what tap-test
/// programs write.
///
/// Datasets lie between lines of −1; all but 58 are skipped. Reads frequency responses (function
/// type 4), complex, single or double, with even or uneven abscissa, of displacement, velocity or
/// acceleration over force; velocity is divided by iω, acceleration by −ω². Units from the axes'
/// labels (m, mm, um, m/s, mm/s, m/s^2, mm/s^2, g; N, kN); SI without a label. Source: SDRC
/// Universal File Datasets Summary, dataset 58.
namespace steadyrest::chatter::offline {

/// All responses of the text. Refused by line: a truncated text, the binary form 58b, another
/// function, data that is not complex, unknown units, no response at all.
[[nodiscard]] kernel::outcome::Result<std::vector<Frf>> parse_uff58(std::string_view text,
                                                                    const std::string& file);

}  // namespace steadyrest::chatter::offline
