// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/grid.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::outcome::refuse;

/// A map of 10⁵ × 10⁵ points would never end; even one side that long is a typing error.
constexpr std::size_t kMostSteps = 100'000;

/// The numbers between the colons; empty when one of them is not a number. from_chars ignores the
/// locale and takes no blanks, so 1,5 and "1 : 2" are refused.
std::vector<double> numbers(const std::string& text) {
  std::vector<double> out;
  const char* const last = text.data() + text.size();
  for (const char* at = text.data();; ++at) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(at, last, value);
    if (error != std::errc{} || !std::isfinite(value) || (end != last && *end != ':')) {
      return {};
    }
    out.push_back(value);
    if (end == last) {
      return out;
    }
    at = end;
  }
}

}  // namespace

/// One value is a grid of one step, so that a map can be a line or a point.
kernel::outcome::Result<std::vector<double>> grid(std::string_view option, const std::string& text,
                                                  double least) {
  const auto bad = [&](std::string_view why) {
    return refuse(fmt::format("{} {}: {}", option, text, why),
                  "write FROM:TO:STEPS, for example 5000:10000:51");
  };
  const std::vector<double> given = numbers(text);
  if (given.size() != 1 && given.size() != 3) {
    return bad("one finite number is needed, or three separated by colons");
  }
  const double from = given[0];
  const double to = given.size() == 3 ? given[1] : from;
  const double count = given.size() == 3 ? given[2] : 1.0;
  if (!(count >= 1.0 && count <= static_cast<double>(kMostSteps)) || count != std::floor(count)) {
    return bad("STEPS must be a whole number, 1 … 100000");
  }
  if (from < least) {
    return bad(fmt::format("the smallest value allowed is {}", least));
  }
  if (count == 1.0 ? to != from : !(to > from)) {
    return bad(count == 1.0 ? "one step does not reach from FROM to TO" : "TO is not above FROM");
  }
  std::vector<double> out;
  const auto steps = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < steps; ++i) {
    const double share = steps == 1 ? 0.0 : static_cast<double>(i) / (count - 1.0);
    // The last value is TO itself: a sum of steps would miss it by rounding.
    out.push_back(i + 1 == steps ? to : from + share * (to - from));
  }
  return out;
}

}  // namespace steadyrest::apps::cli
