// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::nc::read {
namespace {

using Status = LineSource::Status;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> lines_of(LineSource source) {
  std::vector<std::string> out;
  while (source.next() == Status::line) {
    out.emplace_back(source.line());
    EXPECT_EQ(source.number(), out.size());
  }
  return out;
}

/// A file in a folder of its own.
class LineFile {
 public:
  explicit LineFile(const std::string& text) { std::ofstream(path(), std::ios::binary) << text; }
  [[nodiscard]] std::string path() const { return folder_.at("program.nc"); }
  [[nodiscard]] LineSource open() const { return LineSource::open(path()).value(); }

 private:
  kernel::file::testing::OwnFolder folder_;
};

TEST(LineSource, EndsLinesWithLfOrCrLfAndTheLastWithNothing) {
  EXPECT_THAT(lines_of(LineSource::from_text("a\nb\r\n\nc")), ElementsAre("a", "b", "", "c"));
  EXPECT_THAT(lines_of(LineSource::from_text("a\n")), ElementsAre("a"));
  EXPECT_THAT(lines_of(LineSource::from_text("")), ElementsAre());
  // A CR inside a line, or two at its end, is not a line end.
  EXPECT_THAT(lines_of(LineSource::from_text("a\rb\r\r\n")), ElementsAre("a\rb\r"));
}

// Controls count the line end against the longest line, so its length is told.
TEST(LineSource, TellsTheLengthOfEachLineEnd) {
  LineSource source = LineSource::from_text("a\nb\r\nc");
  std::vector<std::size_t> lengths;
  while (source.next() == Status::line) {
    lengths.push_back(source.ending_length());
  }
  EXPECT_THAT(lengths, ElementsAre(1, 2, 0));
}

// Lines of all lengths lie across every border of the buffer's 256 KiB chunks.
TEST(LineSource, AFileGivesTheLinesOfItsText) {
  EXPECT_TRUE(rc::check([] {
    std::string text;
    std::vector<std::string> wanted;
    const int count = *rc::gen::inRange(1, 40);
    for (int i = 0; i < count; ++i) {
      const auto length = static_cast<std::size_t>(*rc::gen::inRange(0, 40'000));
      wanted.emplace_back(length, static_cast<char>('A' + i % 26));
      text += wanted.back() + (i % 3 == 0 ? "\r\n" : "\n");
    }
    const LineFile file(text);
    RC_ASSERT(lines_of(file.open()) == wanted);
  }));
}

TEST(LineSource, TakesTheLongestLineAndNotALongerOne) {
  const std::string longest(LineSource::kLongestLine, 'X');
  for (const bool from_file : {false, true}) {
    for (const char* more : {"", "X"}) {
      const std::string text = longest + more + "\nG0\n";
      const LineFile file(text);
      LineSource source = from_file ? file.open() : LineSource::from_text(text);
      EXPECT_EQ(source.next(), *more == 0 ? Status::line : Status::too_long) << from_file;
    }
  }
}

// A loop goes back to its head: within the buffer, and to what was read long ago.
TEST(LineSource, GoesBackToAPlaceThatItTold) {
  std::string text;
  for (int i = 0; i < 60'000; ++i) {
    text += "G1 X" + std::to_string(i) + "\n";
  }
  const LineFile file(text);
  LineSource source = file.open();
  const auto read_to = [&](std::uint32_t number) {
    while (source.number() < number) {
      ASSERT_EQ(source.next(), Status::line);
    }
  };
  read_to(10);
  const auto place = source.offset();
  for (const std::uint32_t last : {12U, 50'000U}) {
    read_to(last);
    ASSERT_TRUE(source.seek(place, 10));
    ASSERT_EQ(source.next(), Status::line);
    EXPECT_EQ(source.line(), "G1 X10");
    EXPECT_EQ(source.number(), 11U);
  }
  // Forward again, and beyond the end.
  ASSERT_TRUE(source.seek(text.size(), 60'000));
  EXPECT_EQ(source.next(), Status::end);
}

TEST(LineSource, SkipsALineOnlyIfItIsWholeAndTheNextOne) {
  LineSource source = LineSource::from_text("G0 X1\nG0 X2\nG0");
  EXPECT_FALSE(source.skip("G0 X2\n"));
  EXPECT_TRUE(source.skip("G0 X1\n"));
  EXPECT_EQ(source.number(), 1U);
  ASSERT_EQ(source.next(), Status::line);
  EXPECT_EQ(source.line(), "G0 X2");
  EXPECT_FALSE(source.skip("G0\n"));  // the last line has no end
}

TEST(LineSource, APipeHasNoWayBack) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(::pipe(ends), 0);
  const std::string text(100, 'G');
  ASSERT_GT(::write(ends[1], (text + "\nM2\n").data(), text.size() + 4), 0);
  ::close(ends[1]);
  LineSource source = LineSource::open("/proc/self/fd/" + std::to_string(ends[0])).value();
  ::close(ends[0]);
  EXPECT_EQ(source.next(), Status::line);
  EXPECT_TRUE(source.seek(0, 0));  // still in the buffer
  EXPECT_FALSE(source.seek(1'000'000, 7));
}

TEST(LineSource, MovesWithItsFile) {
  const LineFile file("a\nb\nc\n");
  LineSource first = file.open();
  ASSERT_EQ(first.next(), Status::line);
  LineSource second = std::move(first);
  EXPECT_EQ(second.line(), "a");
  ASSERT_EQ(second.next(), Status::line);
  EXPECT_EQ(second.line(), "b");
  second = file.open();
  EXPECT_THAT(lines_of(std::move(second)), ElementsAre("a", "b", "c"));
}

TEST(LineSource, SaysWhyAFileCannotBeRead) {
  const LineFile file("a\n");
  const auto missing = LineSource::open(file.path() + ".none");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().what, HasSubstr("cannot be read"));
  const auto folder = LineSource::open("/");
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().what, HasSubstr("it is a directory"));
}

}  // namespace
}  // namespace steadyrest::nc::read
