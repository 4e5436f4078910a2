// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Every G word from G0.0 to G99.9 and every M word with a tenth, in each dialect.
namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;

// Found with rs274 2.9, one program per code: all that it does not reject with "Unknown g code
// used".
const std::vector<double> kOfRs274 = {
    0,    1,    2,    3,    4,    5,    5.1,  5.2,  5.3,  7,  8,    10,   17,   17.1, 18,
    18.1, 19,   19.1, 20,   21,   28,   28.1, 30,   30.1, 33, 33.1, 38.2, 38.3, 38.4, 38.5,
    40,   41,   41.1, 42,   42.1, 43,   43.1, 43.2, 49,   52, 53,   54,   55,   56,   57,
    58,   59,   59.1, 59.2, 59.3, 61,   61.1, 64,   70,   71, 71.1, 71.2, 72,   72.1, 72.2,
    73,   74,   76,   80,   81,   82,   83,   84,   85,   86, 87,   88,   89,   90,   90.1,
    91,   91.1, 92,   92.1, 92.2, 92.3, 93,   94,   95,   96, 97,   98,   99};
// Planes of U V W and lathe cycles.
const std::vector<double> kNotInterpreted = {17.1, 18.1, 19.1, 70, 71, 71.1, 71.2, 72, 72.1, 72.2};

// G code system of the machining centres, without what README.md of steadyrest/nc refuses.
const std::vector<double> kOfFanuc = {
    0,    1,    2,    3,  4,  5,  5.1, 8,  9,  10, 13.1, 15,   16,   17, 18,   19, 20, 21,
    22,   23,   25,   26, 28, 30, 40,  43, 44, 49, 50,   50.1, 50.2, 51, 51.1, 52, 53, 54,
    54.1, 55,   56,   57, 58, 59, 61,  62, 64, 68, 69,   73,   74,   76, 80,   81, 82, 83,
    84,   84.2, 84.3, 85, 86, 87, 88,  89, 90, 91, 92,   93,   94,   95, 96,   97, 98, 99};
// Haas: bolt patterns as well.
const std::vector<double> kOfHaas = [] {
  std::vector<double> codes = kOfFanuc;
  codes.insert(codes.end(), {70, 71, 72});
  return codes;
}();
// 840D sl programming manual, list of G functions, those below G100 that README.md names.
const std::vector<double> kOfSinumerik = {0,  1,  2,  3,  4,  9,  17, 18, 19, 40, 53, 54, 55,
                                          56, 57, 60, 64, 70, 71, 90, 91, 93, 94, 95, 96, 97};

/// Whether the decoder knows the word; anything missing in the block is found later.
bool is_word(const std::string& word, Dialect dialect) {
  Config config;
  config.dialect = dialect;
  const std::string reason = reason_of(word + "\n", config);
  const std::vector<std::string> unknown = {"unknown_g_code",
                                            "g_code_not_interpreted",
                                            "ambiguous_code",
                                            "lathe_code",
                                            "macro_call",
                                            "unknown_m_code",
                                            "m_code_not_interpreted",
                                            "machine_builders_code"};
  return std::ranges::find(unknown, reason) == unknown.end();
}

TEST(Dialects, AreNamedInTheOrderOfTheEnumerationAndFoundByTheirNames) {
  for (std::size_t i = 0; i < kernel::machine::kDialectNames.size(); ++i) {
    const auto dialect = static_cast<Dialect>(i);
    EXPECT_EQ(read::name(dialect), kernel::machine::kDialectNames[i]);
    EXPECT_EQ(read::dialect_from_name(read::name(dialect)), dialect);
  }
  EXPECT_EQ(kernel::machine::kDialectNames.back(), "mach3");
  EXPECT_FALSE(read::dialect_from_name(""));
}

TEST(Codes, OfADialectAreThoseOfItsListToTheTenth) {
  std::vector<double> of_linuxcnc = kOfRs274;
  std::erase_if(of_linuxcnc, [](double code) {
    return std::ranges::find(kNotInterpreted, code) != kNotInterpreted.end();
  });
  const std::pair<Dialect, std::vector<double>> lists[] = {{Dialect::linuxcnc, of_linuxcnc},
                                                           {Dialect::fanuc, kOfFanuc},
                                                           {Dialect::haas, kOfHaas},
                                                           {Dialect::sinumerik, kOfSinumerik}};
  for (const auto& [dialect, list] : lists) {
    for (int code = 0; code < 1000; ++code) {
      const bool known = std::ranges::find(list, code / 10.0) != list.end();
      EXPECT_EQ(is_word(fmt::format("G{}.{}", code / 10, code % 10), dialect), known)
          << read::name(dialect) << " G" << code / 10.0;
    }
  }
}

// Hundredths are not codes either; RS274/NGC tolerates 0.0001.
TEST(Codes, HaveNothingBelowTheTenth) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik,
                                Dialect::haas, Dialect::grbl, Dialect::mach3}) {
    for (const char* word : {"G0.05", "G1.01", "G7.95", "G17.999", "G53.98", "G54.04", "G59.14",
                             "G90.06", "G92.001"}) {
      EXPECT_FALSE(is_word(word, dialect)) << word;
    }
  }
}

TEST(Codes, OfMWordsHaveNoTenths) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik,
                                Dialect::haas, Dialect::grbl, Dialect::mach3}) {
    for (int code = 0; code < 1000; ++code) {
      if (code % 10 != 0) {
        EXPECT_FALSE(is_word(fmt::format("M{}.{}", code / 10, code % 10), dialect)) << code;
      }
    }
  }
}

TEST(Codes, CylindricalInterpolationIsRefusedByName) {
  Config config;
  config.dialect = Dialect::fanuc;
  Kept kept;
  const auto report = run_text("G7.1 C50\n", config, kept);
  ASSERT_TRUE(report && !report->refused.empty());
  EXPECT_EQ(report->refused.front().word, "G7.1");
  EXPECT_NE(report->refused.front().text.find("cylindrical interpolation"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
