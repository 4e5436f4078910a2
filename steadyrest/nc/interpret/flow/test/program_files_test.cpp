// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/interpret/flow/program_files.hpp>

namespace steadyrest::nc::interpret {
namespace {

using kernel::file::testing::OwnFolder;
using read::LineSource;
using testing::ElementsAre;
using testing::IsEmpty;

/// The next line's text, or "end".
std::string next_text(ProgramFiles& files) {
  return files.next() == LineSource::Status::line ? std::string{files.now().line()} : "end";
}

TEST(ProgramFiles, ALoopGoesBackToTheLineAndACallToTheOneAfterIt) {
  LineSource main = LineSource::from_text("one\ntwo\nthree\n");
  ProgramFiles files(main, {});
  EXPECT_EQ(next_text(files), "one");
  EXPECT_EQ(next_text(files), "two");
  const Place head = files.line_begin();
  const Place back = files.line_end();
  EXPECT_EQ(head.line, 1U);
  EXPECT_EQ(back.line, 2U);
  EXPECT_EQ(next_text(files), "three");
  ASSERT_TRUE(files.go(head));
  EXPECT_EQ(next_text(files), "two");
  EXPECT_EQ(files.now().number(), 2U);
  ASSERT_TRUE(files.go(back));
  EXPECT_EQ(next_text(files), "three");
  EXPECT_EQ(files.now().number(), 3U);
  EXPECT_EQ(next_text(files), "end");
}

TEST(ProgramFiles, ASubprogramsFileIsReadFromItsBeginningAndLeftForTheProgram) {
  const OwnFolder folder;
  folder.file("hole.ngc", "o<hole> sub\no<hole> endsub\n");
  LineSource main = LineSource::from_text("o<hole> call\nM2\n");
  ProgramFiles files(main, {folder.path().string()});
  EXPECT_EQ(next_text(files), "o<hole> call");
  const Place back = files.line_end();
  const auto file = files.find("hole");
  ASSERT_TRUE(file);
  EXPECT_TRUE(files.in_main());  // found, but not gone to
  for (int call = 0; call < 2; ++call) {
    ASSERT_TRUE(files.go(*file));
    EXPECT_FALSE(files.in_main());
    EXPECT_EQ(files.path(), folder.at("hole.ngc"));
    EXPECT_EQ(next_text(files), "o<hole> sub");
    EXPECT_EQ(files.now().number(), 1U);
    ASSERT_TRUE(files.go(back));
    EXPECT_TRUE(files.in_main());
    EXPECT_EQ(files.path(), "");
    EXPECT_EQ(next_text(files), "M2");
  }
}

// The first folder that has one of the names; of its names the first.
TEST(ProgramFiles, AreLookedForFolderByFolder) {
  const OwnFolder first;
  const OwnFolder second;
  first.file("B.nc", "first B\n");
  second.file("A.nc", "second A\n");
  second.file("B.nc", "second B\n");
  LineSource main = LineSource::from_text("");
  ProgramFiles files(main, {first.path().string(), second.path().string()});
  const auto text_of = [&](const std::vector<std::string>& names) {
    const auto place = files.find(names);
    return place && files.go(*place) ? next_text(files) : "none";
  };
  EXPECT_EQ(text_of({"A.nc", "B.nc"}), "first B");
  EXPECT_EQ(text_of({"A.nc"}), "second A");
  EXPECT_EQ(text_of({"C.nc"}), "none");
  EXPECT_EQ(text_of({"B.nc"}), "first B");  // opened once, read again
  EXPECT_THAT(files.subprograms(), ElementsAre(first.at("B.nc"), second.at("A.nc")));
}

TEST(ProgramFiles, AFolderIsNoProgram) {
  const OwnFolder folder;
  LineSource main = LineSource::from_text("");
  ProgramFiles files(main, {folder.path().parent_path().string()});
  EXPECT_FALSE(files.find(std::vector{folder.path().filename().string()}));
  EXPECT_THAT(files.subprograms(), IsEmpty());
}

}  // namespace
}  // namespace steadyrest::nc::interpret
