// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/edit/key_edit.hpp>

namespace steadyrest::passport {
namespace {

using testing::HasSubstr;

const std::string kText =
    "name = \"mill\"  # ours\n"
    "[contour]   # the limit\n"
    "limit_um = 10   # of the drawing\n"
    "strategy = \"feed_priority\"\n"
    "\n"
    "[override.feed]\n"
    "percent = [50, 100]";

std::string changed(const std::vector<NewValue>& values, const std::string& text = kText) {
  const auto out = with_keys(text, "mill.toml", values);
  return out ? *out : "refused: " + out.error().what;
}

TEST(KeyEdit, ReplacesAValueAndNothingElse) {
  std::string expected = kText;
  expected.replace(expected.find("10 "), 2, "12.5");
  EXPECT_EQ(changed({{"contour", "limit_um", "12.5"}}), expected);
}

TEST(KeyEdit, AddsWhatIsMissing) {
  EXPECT_EQ(
      changed({{"contour", "margin_percent", "3"}, {"contour", "enabled", "true"}}),
      "name = \"mill\"  # ours\n[contour]   # the limit\nmargin_percent = 3\nenabled = true\n" +
          kText.substr(kText.find("limit_um")));
  EXPECT_EQ(changed({{"chatter", "law", "\"sine\""}}), kText + "\n\n[chatter]\nlaw = \"sine\"\n");
  EXPECT_EQ(changed({{"override.feed", "latched_word", "false"}}),
            kText.substr(0, kText.find("percent =")) + "latched_word = false\npercent = [50, 100]");
}

TEST(KeyEdit, ChangesSeveralAtOnceAndKeepsLineEnds) {
  std::string text = kText;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.replace(at, 1, "\r\n");
  }
  const std::string out = changed({{"contour", "limit_um", "8"},
                                   {"contour", "strategy", "\"combined\""},
                                   {"chatter", "law", "\"sine\""}},
                                  text);
  EXPECT_THAT(out, HasSubstr("limit_um = 8   # of the drawing\r\nstrategy = \"combined\"\r\n"));
  EXPECT_THAT(out, HasSubstr("[chatter]\r\nlaw = \"sine\"\r\n"));
}

TEST(KeyEdit, RefusesWhatIsNoValueOrHasNoPlace) {
  EXPECT_THAT(changed({{"contour", "limit_um", "12\nname = 1"}}), HasSubstr("no value"));
  EXPECT_THAT(changed({{"contour", "limit_um", "]"}}), HasSubstr("no value"));
  EXPECT_THAT(changed({{"contour", "limit_um", "1 # x\n"}}), HasSubstr("no value"));
  EXPECT_THAT(changed({{"contour", "limit_um", "1"}}, "contour = { limit_um = 2 }\n"),
              HasSubstr("not a section with a key in each line"));
  EXPECT_THAT(changed({{"contour", "margin", "1"}}, "contour.limit_um = 2\n"),
              HasSubstr("refused"));
  EXPECT_THAT(changed({{"contour", "limit_um", "1"}}, "[contour\n"), HasSubstr("no TOML"));
}

}  // namespace
}  // namespace steadyrest::passport
