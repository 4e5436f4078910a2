// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/inserted_lines.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::nc::rewrite {
namespace {

/// A file of these bytes.
class Bytes {
 public:
  explicit Bytes(const std::string& text) { test::write_file(path(), text); }
  [[nodiscard]] std::string path() const { return folder_.at("program.nc"); }
  [[nodiscard]] SourceLines open() const { return SourceLines::open(path()).value(); }

 private:
  kernel::file::testing::OwnFolder folder_;
};

std::string copied(SourceLines lines) {
  std::string out;
  while (lines.next()) {
    out += lines.line();
    out += lines.ending();
  }
  EXPECT_TRUE(lines.whole());
  return out;
}

// Line and ending together are the file, whatever mixture of ends it has.
RC_GTEST_PROP(SourceLines, AreTheFileByteForByte, ()) {
  std::string text;
  const int count = *rc::gen::inRange(0, 30);
  for (int i = 0; i < count; ++i) {
    text += *rc::gen::element<std::string>("G0 X1", "", " ", "(\r)", "%", "M2");
    text += *rc::gen::element<std::string>("\n", "\r\n", "\r\r\n", "\n\n");
  }
  text += *rc::gen::element<std::string>("", "M30", "M30\r", "\r");
  const Bytes file(text);
  RC_ASSERT(copied(file.open()) == text);
}

TEST(SourceLines, TellTheEndOfEachLine) {
  const Bytes file("a\r\nb\nc");
  SourceLines lines = file.open();
  std::vector<std::string> ends;
  while (lines.next()) {
    ends.emplace_back(lines.ending());
  }
  EXPECT_EQ(ends, (std::vector<std::string>{"\r\n", "\n", ""}));
  EXPECT_EQ(lines.number(), 4U);
}

// A pair of programs is read in step: the same line with the same end is skipped in the other.
TEST(SourceLines, SkipTheSameLineWithTheSameEnd) {
  const Bytes one("G0 X1\nG0 X2\nG0 X3\r\nM2");
  const Bytes other("G0 X1\nG0 X2\nG0 X3\nM2");
  SourceLines a = one.open();
  SourceLines b = other.open();
  ASSERT_TRUE(a.next());
  EXPECT_FALSE(b.skip(a.line(), a.ending())) << "nothing has been read yet";
  ASSERT_TRUE(b.next());
  ASSERT_TRUE(a.next());
  EXPECT_TRUE(b.skip(a.line(), a.ending()));
  ASSERT_TRUE(a.next());
  EXPECT_FALSE(b.skip(a.line(), a.ending())) << "LF is not CR LF";
  ASSERT_TRUE(b.next());
  EXPECT_EQ(b.line(), "G0 X3");
  EXPECT_EQ(b.number(), 3U);
  ASSERT_TRUE(a.next());
  EXPECT_FALSE(b.skip(a.line(), a.ending())) << "a line without an end may go on in the other";
}

TEST(SourceLines, ALineThatIsTooLongIsNotTheFilesEnd) {
  const Bytes file("G0\n" + std::string(70'000, 'X') + "\nM2\n");
  SourceLines lines = file.open();
  EXPECT_TRUE(lines.next());
  EXPECT_FALSE(lines.next());
  EXPECT_FALSE(lines.whole());
  EXPECT_FALSE(SourceLines::open(file.path() + ".none"));
}

// The truth is a plain search; lookups go forward, back and over lines that are none.
RC_GTEST_PROP(InsertedLines, AreFoundInAnyOrder, ()) {
  std::vector<std::uint32_t> numbers;
  std::uint32_t line = 0;
  const int count = *rc::gen::inRange(0, 20);
  for (int i = 0; i < count; ++i) {
    numbers.push_back(line += static_cast<std::uint32_t>(*rc::gen::inRange(1, 5)));
  }
  InsertedLines inserted(numbers);
  RC_ASSERT(inserted.size() == numbers.size());
  for (int i = 0; i < 50; ++i) {
    const auto at = static_cast<std::uint32_t>(*rc::gen::inRange(0, 70));
    const auto found = std::ranges::lower_bound(numbers, at);
    RC_ASSERT(inserted.has(at) == (found != numbers.end() && *found == at));
    RC_ASSERT(inserted.before() == static_cast<std::uint32_t>(found - numbers.begin()));
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
