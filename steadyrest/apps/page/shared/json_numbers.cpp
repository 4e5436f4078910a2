// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/apps/page/shared/json_numbers.hpp>

namespace steadyrest::apps::page {

/// Six significant digits: 5 − floor(log10|x|) decimals. A scale that overflows belongs to a number
/// too small to draw.
double short_number(double value) {
  if (!std::isfinite(value) || value == 0.0) {
    return value;
  }
  const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) ? std::round(value * scale) / scale : 0.0;
}

/// A column of a picture; these make up most of a page's size.
nlohmann::ordered_json short_numbers(const std::vector<double>& values) {
  nlohmann::ordered_json::array_t out;
  out.reserve(values.size());
  for (const double value : values) {
    out.emplace_back(short_number(value));
  }
  return out;
}

}  // namespace steadyrest::apps::page
