// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>

// The functions in expressions of the dialect `sinumerik`.
namespace steadyrest::nc::read {
namespace {

using kernel::units::kDegree;

}  // namespace

// From the ( to its ); the bracket counts as one level, like any other.
// Each function has a fixed number of values; one more is refused, since the closing bracket is
// missing.
bool SinumerikExpression::arguments(std::array<double, 3>& values, std::size_t wanted) {
  ++at_;
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than 64 deep");
  }
  for (std::size_t i = 0; i < wanted; ++i) {
    if (i > 0 && peek() != ',') {
      return fail("bad_function", "a function with too few values");
    }
    at_ += i > 0 ? 1 : 0;
    if (!read(values[i])) {
      return false;
    }
  }
  return closing(')');
}

// Functions of "Job planning" by name, number of values and domain.
bool SinumerikExpression::function(std::string_view name, double& out) {
  struct Known {
    std::string_view name;
    std::size_t values;
    double (*law)(double, double, double);
    double lowest = -1e300;
    double highest = 1e300;
  };
  // Degrees in and out, as everywhere in NC programs. POT is the square, TRUNC rounds towards
  // zero; BOUND(low, high, x) clips x.
  static constexpr std::array kKnown = {
      Known{"SIN", 1, [](double x, double, double) { return std::sin(x * kDegree); }},
      Known{"COS", 1, [](double x, double, double) { return std::cos(x * kDegree); }},
      Known{"TAN", 1, [](double x, double, double) { return std::tan(x * kDegree); }},
      Known{"ASIN", 1, [](double x, double, double) { return std::asin(x) / kDegree; }, -1.0, 1.0},
      Known{"ACOS", 1, [](double x, double, double) { return std::acos(x) / kDegree; }, -1.0, 1.0},
      Known{"ATAN2", 2, [](double y, double x, double) { return std::atan2(y, x) / kDegree; }},
      Known{"SQRT", 1, [](double x, double, double) { return std::sqrt(x); }, 0.0},
      Known{"ABS", 1, [](double x, double, double) { return std::abs(x); }},
      Known{"POT", 1, [](double x, double, double) { return x * x; }},
      Known{"TRUNC", 1, [](double x, double, double) { return std::trunc(x); }},
      Known{"ROUND", 1, [](double x, double, double) { return std::round(x); }},
      Known{"LN", 1, [](double x, double, double) { return std::log(x); }, 1e-300},
      Known{"EXP", 1, [](double x, double, double) { return std::exp(x); }},
      Known{"MINVAL", 2, [](double x, double y, double) { return std::min(x, y); }},
      Known{"MAXVAL", 2, [](double x, double y, double) { return std::max(x, y); }},
      Known{"BOUND", 3,
            [](double low, double high, double x) { return std::max(low, std::min(high, x)); }},
  };
  const auto* const found =
      std::ranges::find_if(kKnown, [&](const Known& one) { return equal(name, one.name); });
  if (found == kKnown.end()) {
    return fail("unknown_function", "a function that is unknown or not interpreted");
  }
  std::array<double, 3> values{};
  if (!arguments(values, found->values)) {
    return false;
  }
  // The domain applies to the first value; the others take anything.
  if (!(values[0] >= found->lowest && values[0] <= found->highest)) {
    return fail("out_of_domain", "a function of a number outside its domain");
  }
  out = found->law(values[0], values[1], values[2]);
  return finite(out);
}

}  // namespace steadyrest::nc::read
