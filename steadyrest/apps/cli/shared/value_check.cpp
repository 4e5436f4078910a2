// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <system_error>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/value_check.hpp>

namespace steadyrest::apps::cli {
namespace {

constexpr const char* kFine = "";

template <class Number>
std::errc read(std::string_view text, Number& number) {
  // from_chars takes no leading +; people write +0.5.
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end != text.data() + text.size() ? std::errc::invalid_argument
                                                                  : error;
}

/// Finite decimal numbers only. from_chars also reads inf and nan, which a range check does not
/// always stop.
std::string fault_of_real(const std::string& given) {
  double number = 0.0;
  const std::errc error = read(given, number);
  if (error == std::errc::result_out_of_range || (error == std::errc{} && !std::isfinite(number))) {
    return given + " is not a finite number";
  }
  if (error != std::errc{}) {
    // 1,5 is the usual slip on a keyboard with a decimal comma.
    return given + " is not a number" +
           (given.find(',') == std::string::npos ? "" : ", which has a decimal point");
  }
  return kFine;
}

/// Whole decimal numbers that fit.
template <class Whole>
std::string fault_of_whole(const std::string& given) {
  Whole number = 0;
  const std::errc error = read(given, number);
  if (error == std::errc::result_out_of_range) {
    return given + " is too large";
  }
  // Well-formed but negative, or no number at all: two different mistakes.
  if (error != std::errc{}) {
    std::int64_t negative = 0;
    return given +
           (read(given, negative) == std::errc{} ? " is below 0" : " is not a whole number");
  }
  // CLI11 takes it for octal.
  const std::size_t first = given.find_first_of("0123456789");
  return given[first] == '0' && given.size() > first + 1 ? given + " begins with 0" : kFine;
}

std::string fault_of(const std::string& type, const std::string& given) {
  if (given.empty()) {
    return "is empty";
  }
  return type.starts_with("FLOAT")  ? fault_of_real(given)
         : type.starts_with("UINT") ? fault_of_whole<std::uint64_t>(given)
         : type.starts_with("INT")  ? fault_of_whole<std::int64_t>(given)
                                    : kFine;
}

}  // namespace

void check_value(CLI::Option& option) {
  option.check(
      [type = option.get_type_name()](const std::string& given) { return fault_of(type, given); });
}

CLI::Validator within(double least, double most) {
  // Empty means valid to CLI11. check_value(), which runs first, deals with anything that is not a
  // number.
  return {[least, most](const std::string& given) {
            double value = 0.0;
            return read(given, value) == std::errc{} && value >= least && value <= most
                       ? std::string{}
                       : fmt::format("{} is outside {:g} to {:g}", given, least, most);
          },
          fmt::format("in [{:g} - {:g}]", least, most)};
}

/// 1e-9 … 1e12 keeps every product and quotient of these verbs far inside the range of a double.
void check_size(CLI::App& verb) {
  for (CLI::Option* option :
       verb.get_options([](const CLI::Option* one) { return one->get_type_name() == "FLOAT"; })) {
    option->check(within(1e-9, 1e12).description(""));
  }
}

}  // namespace steadyrest::apps::cli
