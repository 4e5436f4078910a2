// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

namespace steadyrest::apps::page {

/// To six digits, enough for a picture; non-finite numbers stay, and nlohmann-json writes them as
/// null.
[[nodiscard]] double short_number(double value);

/// A column of them.
[[nodiscard]] nlohmann::ordered_json short_numbers(const std::vector<double>& values);

}  // namespace steadyrest::apps::page
