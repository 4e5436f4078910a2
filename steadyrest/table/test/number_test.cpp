// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/table/number.hpp>

namespace steadyrest::table {
namespace {

/// A file's column of numbers: the values, or the fault that ends it (as `LINE: what`).
struct Column {
  std::vector<double> value;
  std::string fault;
};

Column read_all(const std::vector<std::string>& fields, Decimal decimal = Decimal::by_file) {
  NumberReader reader(decimal);
  Column out;
  std::size_t line = 1;
  for (const std::string& field : fields) {
    const auto value = reader.read(field, "z_um", ++line);
    if (!value) {
      out.fault = fmt::format("{}: {}", value.error().line, value.error().what);
      EXPECT_FALSE(value.error().to_do.empty());
      return out;
    }
    out.value.push_back(*value);
  }
  if (const auto fault = reader.unproved()) {
    out.fault = fmt::format("{}: {}", fault->line, fault->what);
  }
  return out;
}

// A number printed to the last digit comes back bit for bit; from_chars and printf share no code.
RC_GTEST_PROP(Number, ComesBackAsItWasPrinted, (double value)) {
  RC_PRE(std::isfinite(value));
  std::string text = fmt::format("{:.17g}", value);
  RC_ASSERT(plain_number(text) == value);
  RC_ASSERT(like_a_number(text));
  if (value >= 0.0) {
    RC_ASSERT(plain_number("+" + text) == value);
  }
  if (text.find('.') != std::string::npos) {
    text.replace(text.find('.'), 1, ",");
    const auto column = read_all({text}, Decimal::comma);
    RC_ASSERT(column.fault.empty());
    RC_ASSERT(column.value.front() == value);
  }
}

// A comma proves itself where it could not group digits: grouping needs one to three digits before
// it, the first not 0, and three after. The rule as a pattern, over all short numbers.
RC_GTEST_PROP(Number, OneCommaThatCannotGroupDecidesTheFile, ()) {
  static const std::regex kGrouped("[+-]?[1-9][0-9]{0,2},[0-9]{3}");
  const std::string field =
      *rc::gen::element<std::string>("", "-", "+") +
      fmt::format("{},{}", *rc::gen::element("0", "00", "7", "12", "123", "1234", "012"),
                  *rc::gen::element("0", "25", "250", "2500", "000"));
  const auto column = read_all({"1,234", field, "5"});
  const bool proved = !std::regex_match(field, kGrouped);
  RC_ASSERT(column.fault.empty() == proved);
  RC_ASSERT(column.value.size() == 3U);
  RC_ASSERT(column.value[0] == 1.234);
}

TEST(Number, AFileOfGroupsAloneIsRefusedAtItsFirstComma) {
  EXPECT_EQ(read_all({"5", "1,234", "2,345"}).fault,
            "3: the comma may be a decimal mark or a thousands separator, here and throughout the "
            "file");
  EXPECT_EQ(read_all({"1,234"}, Decimal::comma).fault, "") << "the caller has said what it is";
  EXPECT_EQ(read_all({"5", "6"}).fault, "") << "no comma, no doubt";
}

// Both orders, and both decisions that the caller may have made.
TEST(Number, PointAndCommaInOneFileContradictEachOther) {
  EXPECT_EQ(read_all({"0.5", "0,5"}).fault, "3: z_um = \"0,5\" has a comma, line 2 a point");
  EXPECT_EQ(read_all({"0,5", "1", "0.5"}).fault, "4: z_um = \"0.5\" has a point, line 2 a comma");
  EXPECT_EQ(read_all({"1", "0,5"}, Decimal::point).fault,
            "3: z_um = \"0,5\" has a comma; --decimal point is given");
  EXPECT_EQ(read_all({"1", "0.5"}, Decimal::comma).fault,
            "3: z_um = \"0.5\" has a point; --decimal comma is given");
}

TEST(Number, IsFiniteAndAloneInItsField) {
  for (const std::string text : {"inf", "nan", "1e999", "1 mm", "--1", "+-1", "0x10", "1.2.3"}) {
    EXPECT_EQ(read_all({text}).fault, fmt::format("2: z_um = \"{}\" is not a finite number", text));
  }
  EXPECT_EQ(read_all({""}).fault, "2: z_um is empty");
  EXPECT_EQ(read_all({"1,234.5"}).fault, "2: z_um = \"1,234.5\" is not a finite number");
  EXPECT_EQ(read_all({"1,2,3"}).fault, "2: z_um = \"1,2,3\" is not a finite number");
  EXPECT_EQ(read_all({"0,1x"}).fault, "2: z_um = \"0,1x\" is not a finite number");
}

// 64 characters are more digits than any logger writes; longer is no number but garbage.
TEST(Number, WithACommaHasAtMostSixtyFourCharacters) {
  const std::string most = "0," + std::string(62, '3');
  EXPECT_NEAR(read_all({most}).value.at(0), 1.0 / 3.0, 1e-15);
  EXPECT_NE(read_all({most + "3"}).fault, "");
}

// Digits after the mark, less the exponent, never below zero.
TEST(Number, KnowsItsDecimals) {
  const std::vector<std::pair<std::string_view, int>> known = {
      {"5", 0},     {"5.", 0},      {"0.125", 3},  {"0,125", 3}, {"1.5e-3", 4},
      {"1.5E2", 0}, {"1.25e+1", 1}, {"1e-12", 12}, {"-0.50", 2}, {"1e-99999999", 400}};
  for (const auto& [text, decimals] : known) {
    EXPECT_EQ(decimals_of(text), decimals) << text;
  }
}

// It tells rows from heads: every number looks like one, and no name does.
TEST(Number, NamesAreNotLikeNumbers) {
  for (const std::string_view name : {"", "z_um", "e", "-", ".", "E+", "t1", "1st", "#1"}) {
    EXPECT_FALSE(like_a_number(name)) << name;
  }
  for (const std::string_view number : {"1", "-.5", "+1,5e-3", "2026"}) {
    EXPECT_TRUE(like_a_number(number)) << number;
  }
}

}  // namespace
}  // namespace steadyrest::table
