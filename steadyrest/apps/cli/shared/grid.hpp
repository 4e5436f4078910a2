// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

/// `A:B:N`: N even steps from A to B, both included; `A` alone or `A:A:1`: one value. `option` is
/// its name in refusals. Refused: anything but numbers, B not above A, N outside 1 … 100000, values
/// below `least`.
[[nodiscard]] kernel::outcome::Result<std::vector<double>> grid(std::string_view option,
                                                                const std::string& text,
                                                                double least);

}  // namespace steadyrest::apps::cli
