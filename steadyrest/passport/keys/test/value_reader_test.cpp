// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// One value, read by the key `max_feed_mm_min` of 1 … 5000, or by another key.
template <class T>
struct ReadOne {
  std::optional<T> value;
  std::string fault;  ///< of the only one; empty: none
  std::size_t line = 0;

  ReadOne(std::string_view text, bool (ValueReader::*read)(const toml::node&, T&) const,
          double min = 1.0, double max = 5000.0, std::string_view key = "max_feed_mm_min") {
    const toml::table table = toml::parse("\nv = " + std::string(text) + "\n");
    Faults faults{"m.toml", {}};
    const ValueReader reader(faults, key, min, max, 3);
    T out{};
    if ((reader.*read)(*table.get("v"), out)) {
      value = out;
    }
    EXPECT_EQ(faults.list.size(), value ? 0U : 1U) << text;
    if (!faults.list.empty()) {
      fault = faults.list.front().what;
      line = faults.list.front().line;
    }
  }
};

TEST(ValueReader, TakesANumberUpToBothEndsOfItsRange) {
  for (const std::string_view text : {"1", "1.0", "5000", "5e3", "0x10"}) {
    EXPECT_TRUE(ReadOne<double>(text, &ValueReader::number).value.has_value()) << text;
  }
  for (const std::string_view text : {"0.999", "5000.001", "-3", "0"}) {
    const ReadOne<double> refused(text, &ValueReader::number);
    EXPECT_THAT(refused.fault, HasSubstr("out of range; allowed: 1 … 5000 mm/min")) << text;
    EXPECT_EQ(refused.line, 2U);
  }
}

TEST(ValueReader, ANumberIsNeitherInfiniteNorQuoted) {
  for (const std::string_view text : {"inf", "-inf", "nan"}) {
    EXPECT_THAT(ReadOne<double>(text, &ValueReader::number).fault, HasSubstr("not a finite"));
  }
  EXPECT_THAT(ReadOne<double>("\"50 mm/min\"", &ValueReader::number).fault,
              HasSubstr("= \"50 mm/min\" is a text; a number in mm/min is needed"));
  EXPECT_THAT(ReadOne<double>("true", &ValueReader::number).fault, HasSubstr("= true is a switch"));
  EXPECT_THAT(ReadOne<double>("2026-01-01", &ValueReader::number).fault, HasSubstr("a date"));
}

// From 2^53 + 1 on a double is another number than was written.
TEST(ValueReader, AWholeNumberIsExactOrRefused) {
  constexpr double kMost = 9007199254740992.0;
  const auto read = [&](std::string_view text) {
    return ReadOne<std::int64_t>(text, &ValueReader::integer, 0.0, kMost, "seed");
  };
  EXPECT_EQ(read("9007199254740992").value, 9007199254740992);
  EXPECT_THAT(read("9007199254740993").fault, HasSubstr("allowed: 0 … 9007199254740992"));
  for (const std::string_view text : {"3.0", "1e3", "\"3\"", "false"}) {
    EXPECT_THAT(read(text).fault, HasSubstr("a whole number is needed")) << text;
  }
}

TEST(ValueReader, ATextIsOneLineOfItsLength) {
  const auto read = [](std::string_view text) {
    return ReadOne<std::string>(text, &ValueReader::text, 1.0, 8.0, "name");
  };
  EXPECT_EQ(read("\"Vertical\"").value, "Vertical");
  EXPECT_THAT(read("\"Verticals\"").fault, HasSubstr("9 characters; allowed: 1 … 8"));
  EXPECT_THAT(read("\"\"").fault, HasSubstr("0 characters"));
  EXPECT_THAT(read(R"("a\tb")").fault, HasSubstr("control character"));
  EXPECT_THAT(read("7").fault, HasSubstr("name = 7 is a whole number; a text is needed"));
}

TEST(ValueReader, AListEndsAtItsFirstFaultAndHasOneToThreeEntries) {
  using Numbers = std::vector<double>;
  EXPECT_THAT(ReadOne<Numbers>("[1, 2.5, 5000]", &ValueReader::numbers).value.value(),
              ElementsAre(1.0, 2.5, 5000.0));
  EXPECT_THAT(ReadOne<Numbers>("[]", &ValueReader::numbers).fault, HasSubstr("has 0 entries"));
  EXPECT_THAT(ReadOne<Numbers>("[1, 1, 1, 1]", &ValueReader::numbers).fault,
              HasSubstr("4 entries; allowed: 1 … 3"));
  EXPECT_THAT(ReadOne<Numbers>("[0, -1, 2]", &ValueReader::numbers).fault, HasSubstr("= 0 is"));
}

}  // namespace
}  // namespace steadyrest::passport
