// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::HasSubstr;

TEST(Mark, IsReadAsItWasWrittenInEveryDialect) {
  const test::Workshop shop;
  // Blanks, brackets, a semicolon, bytes beyond ASCII, an empty value and a long one: anything that
  // a comment may not hold must be encoded.
  const std::vector<Told> told = {{"window-s", "6"},
                                  {"variables", "a folder/with (brackets); and \xc3\xbc%.var"},
                                  {"block-delete", ""},
                                  {"subprograms", std::string(150, 'a')}};
  for (const Method method : {Method::linuxcnc, Method::haas, Method::frame_fine}) {
    Way way;
    way.method = method;
    const std::string text = mark_text(way, told, "\r\n");
    EXPECT_THAT(text, HasSubstr("a=20folder/with=20=28brackets=29=3B"));
    test::write_file(shop.changed(), "%\r\nO1 (NAME)\r\n" + text + "G21\r\nM2\r\n");
    EXPECT_EQ(read_mark(shop.changed()).value(), told);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
      const std::string line = text.substr(at, text.find('\r', at) - at);
      EXPECT_TRUE(is_inserted(line) && is_head(line)) << line;
      // LinuxCNC's longest line.
      EXPECT_LT(line.size(), 255U);
    }
  }
}

TEST(Mark, IsProvedWithTheHead) {
  test::Workshop shop;
  shop.settings.told = {{"window-s", "60"}};
  ASSERT_TRUE(shop.compensate(test::kPasses, test::kGrowth));
  const std::string text = test::text_of_file(shop.changed());
  const std::string mark = mark_text(Way{}, shop.settings.told, "\n");
  EXPECT_THAT(mark, HasSubstr("(STEADYREST head told --window-s 60 --sum "));
  EXPECT_THAT(text, HasSubstr("%\n" + mark + "#<_steadyrest_z>="));
  EXPECT_TRUE(shop.verify(test::kGrowth));
  EXPECT_THAT(shop.fault(test::kGrowth, test::replaced(text, mark, "")), HasSubstr("head"));
  ASSERT_TRUE(strip(shop.changed(), shop.changed()));
  EXPECT_EQ(test::text_of_file(shop.changed()), test::kPasses);
}

TEST(Mark, IsRefusedWhereItWasChanged) {
  const test::Workshop shop;
  // A digit, a missing word, the sum's name, the mark's name, an empty mark.
  const std::string mark = mark_text(Way{}, {{"dialect", "fanuc"}, {"window-s", "60"}}, "\n");
  for (const std::string& text :
       {test::replaced(mark, "60", "61"), test::replaced(mark, " --window-s 60", ""),
        test::replaced(mark, "--sum", "--some"), test::replaced(mark, "told", "tells"),
        std::string{"(STEADYREST head told )\n"}}) {
    test::write_file(shop.changed(), text + "G21\nM2\n");
    const auto read = read_mark(shop.changed());
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().to_do, HasSubstr("compensate it again"));
  }
}

TEST(Mark, IsMissingInAProgramOfAnEarlierVersion) {
  const test::Workshop shop;
  // From before the mark was introduced: it must not pass as a program without corrections.
  test::write_file(shop.changed(), "R50=0.0000 ;STEADYREST head Z\nG71\nM30\n");
  EXPECT_FALSE(read_mark(shop.changed()));
  test::write_file(shop.changed(), test::kPasses);
  EXPECT_TRUE(read_mark(shop.changed()).value().empty());
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
