// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/text/name.hpp>

namespace steadyrest::nc::read {
namespace {

std::string name_between(const std::string& text, std::size_t& length) {
  Name name;
  const char* const after = read_name(text.data(), text.data() + text.size(), name);
  length = after == nullptr ? 0 : static_cast<std::size_t>(after - text.data());
  return after == nullptr ? "" : std::string{name.view()};
}

// LinuxCNC, "Named Parameters": blanks are removed and letters made small.
TEST(Name, IsInSmallLettersWithoutBlanks) {
  std::size_t length = 0;
  EXPECT_EQ(name_between("<Drill_Depth>", length), "drill_depth");
  EXPECT_EQ(name_between("<\tThe 2nd  Pass >=5", length), "the2ndpass");
  EXPECT_EQ(length, 17U);  // what follows > is not read
  EXPECT_EQ(name_between("<_hal[pin.0]>", length), "_hal[pin.0]");
}

TEST(Name, HasOneToSixtyFourCharacters) {
  std::size_t length = 0;
  EXPECT_EQ(name_between('<' + std::string(64, 'a') + '>', length), std::string(64, 'a'));
  for (const std::string& text : {std::string("<>"), std::string("< >"), std::string("<a"),
                                  std::string("<a\x01>"), '<' + std::string(65, 'a') + '>'}) {
    EXPECT_EQ(name_between(text, length), "") << text;
    EXPECT_EQ(length, 0U) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
