// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/outcome/shown.hpp>

namespace steadyrest::kernel::outcome {
namespace {

TEST(AName, IsShownAsItIsWhereItCanBeSeen) {
  for (const std::string name : {"", "part 1.mpf", "Hüftgelenk_µm.ngc", "деталь.mpf", "零件.nc",
                                 "شغل.nc", "🛠.nc", "back\\slash"}) {
    EXPECT_EQ(shown(name), name);
  }
}

TEST(AName, ShowsWhatWouldNotBeSeenOrTurnTheRest) {
  EXPECT_EQ(shown("part\u202egpj.mpf"), "part\\u202egpj.mpf");
  EXPECT_EQ(shown("a\u2066b\u2069\u061c\u200f\u200b\ufeff"),
            "a\\u2066b\\u2069\\u061c\\u200f\\u200b\\ufeff");
  EXPECT_EQ(shown("red\x1b[31m\r\n\t\x7f"), "red\\x1b[31m\\r\\n\\t\\x7f");
  EXPECT_EQ(shown("\u0085\u2028\u3164"), "\\u0085\\u2028\\u3164");
  EXPECT_EQ(shown("\U000e0041"), "\\U000e0041");
  EXPECT_EQ(shown(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(AName, ShowsBytesThatAreNotUtf8) {
  EXPECT_EQ(shown("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(shown("\xc0\xae\xe2\x80"), "\\xc0\\xae\\xe2\\x80") << "too long, and cut off";
  EXPECT_EQ(shown("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(shown("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(AText, KeepsItsLines) {
  EXPECT_EQ(shown_lines("a\tb\nc\u202e\x1b\n"), "a\tb\nc\\u202e\\x1b\n");
}

TEST(Json, MeansTheSame) {
  const nlohmann::json json = {{"file", "a\u202e\u0085\U000e0041.mpf"}, {"n", 1}};
  const std::string text = shown_json(json.dump(2));
  EXPECT_EQ(text.find("\u202e"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text), json);
}

TEST(ARefusal, IsOneLineWhateverNamesItHas) {
  const Refusal refusal{
      .file = "a\nsteadyrest: b\u202e.mpf", .line = 3, .what = "what\x1b[2J", .to_do = "do"};
  EXPECT_EQ(text(refusal), "a\\nsteadyrest: b\\u202e.mpf:3: what\\x1b[2J; do");
}

}  // namespace
}  // namespace steadyrest::kernel::outcome
