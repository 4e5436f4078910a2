// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <steadyrest/passport/file/words_section.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::BuildersWord;
using Does = BuildersWord::Does;
using testing::HasSubstr;

struct Read {
  std::vector<BuildersWord> words;
  Faults faults{.file = "m.toml", .list = {}};
};

Read read(std::string_view text) {
  Read out;
  read_words(toml::parse(text), out.words, out.faults);
  return out;
}

const BuildersWord* find(const Read& of, std::string_view word) {
  const auto found = std::ranges::find(of.words, word, &BuildersWord::word);
  return found == of.words.end() ? nullptr : &*found;
}

TEST(WordsSection, EveryMeaning) {
  const Read seen = read(
      "M50 = \"none\"\nm07 = \"stop\"\nH12 = \"dwell 0.5\"\nL_Time = \"moves X Z\"\nG187 = "
      "\"opaque\"\n"
      "M60 = \"moves XZA\"\n");
  EXPECT_TRUE(seen.faults.list.empty());
  ASSERT_EQ(seen.words.size(), 6U);
  EXPECT_EQ(find(seen, "M50")->does, Does::nothing);
  EXPECT_EQ(find(seen, "M7")->does, Does::stop);
  EXPECT_EQ(find(seen, "H12")->does, Does::dwell);
  EXPECT_EQ(find(seen, "H12")->dwell_s, 0.5);
  EXPECT_EQ(find(seen, "L_TIME")->axes, "XZ");
  EXPECT_EQ(find(seen, "M60")->axes, "XZA");
  EXPECT_EQ(find(seen, "G187")->does, Does::opaque);
}

TEST(WordsSection, OtherValuesAreRefusedWithTheirLine) {
  for (const std::string_view value :
       {"\"\"", "\"nothing\"", "\"dwell\"", "\"dwell x\"", "\"dwell -1\"", "\"dwell 1e9\"",
        "\"dwell nan\"", "\"moves\"", "\"moves Q\"", "\"moves XX\"", "\"none at all\"", "1", "true",
        "[\"none\"]", "{}"}) {
    const Read seen = read("M1 = \"none\"\nM50 = " + std::string(value) + "\n");
    ASSERT_EQ(seen.faults.list.size(), 1U) << value;
    EXPECT_EQ(seen.faults.list[0].line, 2U) << value;
    EXPECT_THAT(seen.faults.list[0].to_do, HasSubstr("dwell 0.5")) << value;
  }
}

TEST(WordsSection, AKeyThatIsNoWordOrStandsTwiceIsRefused) {
  EXPECT_EQ(read("\"5M\" = \"none\"\n").faults.list.size(), 1U);
  EXPECT_EQ(read("\"M 5\" = \"none\"\n").faults.list.size(), 1U);
  EXPECT_EQ(read("M5 = \"none\"\nm05 = \"stop\"\n").faults.list.size(), 1U);
}

}  // namespace
}  // namespace steadyrest::passport
