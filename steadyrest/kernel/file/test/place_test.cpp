// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <steadyrest/kernel/file/place.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::kernel::file {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Places : public ::testing::Test {
 public:
  Places() {
    folder_.file("log.csv", "t_s,count\n");
    fs::create_directory(at("x"));
    fs::create_symlink("log.csv", at("soft"));
    fs::create_hard_link(at("log.csv"), at("hard"));
    fs::create_directory_symlink(".", at("here"));
  }

 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return folder_.at(name); }
  testing::OwnFolder folder_;
};

// Symbolic, hard, with dots, through a linked folder: all the same file. This catches an output
// that overwrites its own input under another name.
TEST_F(Places, OneFileHasManyNames) {
  for (const char* name :
       {"log.csv", "soft", "hard", "./x/../log.csv", "here/log.csv", "here/here/hard"}) {
    EXPECT_TRUE(same_place(at("log.csv"), at(name))) << name;
  }
  EXPECT_FALSE(same_place(at("log.csv"), at("other.csv")));
  EXPECT_FALSE(same_place(at("other.csv"), at("log.csv")));
}

// Without an inode only the resolved name can tell.
TEST_F(Places, AFileThatIsNotThereYetHasManyNamesToo) {
  fs::create_symlink("new.csv", at("to-new"));
  for (const char* name : {"new.csv", "./x/../new.csv", "here/new.csv", "to-new"}) {
    EXPECT_TRUE(same_place(at("new.csv"), at(name))) << name;
  }
  EXPECT_FALSE(same_place(at("new.csv"), at("newer.csv")));
  EXPECT_FALSE(same_place(at("missing/new.csv"), at("missing/new.csv.x")));
}

TEST_F(Places, ADeviceIsNobodysFile) {
  EXPECT_FALSE(same_place("/dev/null", "/dev/null"));
  EXPECT_EQ(place_of("/dev/full")->kind, Place::Kind::stream);
}

// Removed if nothing was put in; names with dots make the same folder twice.
TEST_F(Places, FoldersThatStayEmptyGoAgain) {
  for (const char* name : {"a/b/c", "a/./b/c/", "a/b/../c"}) {
    {
      const auto made = MadeFolders::make(at(name));
      ASSERT_TRUE(made.has_value()) << name;
      EXPECT_TRUE(fs::is_directory(at(name)));
    }
    EXPECT_FALSE(fs::exists(at("a"))) << name;
  }
  {
    const auto made = MadeFolders::make(at("a/b"));
    std::ofstream(at("a/b/file")) << "x";
  }
  EXPECT_TRUE(fs::exists(at("a/b/file")));
  EXPECT_FALSE(MadeFolders::make(at("log.csv/below")).has_value());
  EXPECT_FALSE(MadeFolders::make(at("log.csv")).has_value());
  EXPECT_FALSE(MadeFolders::make("/dev/null/here").has_value());
}

// Each refusal names the path as given and says what to do.
TEST_F(Places, RefusesWhatCannotBeWritten) {
  ASSERT_EQ(chmod(at("hard").c_str(), 0444), 0);
  fs::create_symlink("round", at("round"));
  for (const auto& [name, what] : {std::pair{"x", "is a folder"},
                                   {"new/", "is the name of a folder"},
                                   {"log.csv", "write-protected"},
                                   {"missing/out.csv", "folder is out of reach"},
                                   {"log.csv/out.csv", "not writable"},
                                   {"round", "not writable"}}) {
    const auto place = place_of(at(name));
    ASSERT_FALSE(place.has_value()) << name;
    EXPECT_THAT(outcome::text(place.error()), HasSubstr(what));
    EXPECT_THAT(outcome::text(place.error()), HasSubstr(at(name)));
    EXPECT_FALSE(place.error().to_do.empty());
  }
  EXPECT_FALSE(place_of("").has_value());
}

// Permission does not help on a read-only file system.
TEST(Unwritable, SpeaksOfPermissionsOnlyWhereTheyAreMissing) {
  for (const char* const thing : {"file", "folder"}) {
    for (const int error : {EACCES, EPERM}) {
      EXPECT_THAT(unwritable(thing, error).what, HasSubstr("write-protected"));
      EXPECT_THAT(unwritable(thing, error).to_do, HasSubstr("permission"));
    }
    EXPECT_THAT(unwritable(thing, EROFS).what, HasSubstr("read-only file system"));
    EXPECT_THAT(unwritable(thing, EIO).what, HasSubstr("Input/output error"));
    for (const int error : {EROFS, ETXTBSY, EIO}) {
      const Unwritable why = unwritable(thing, error);
      EXPECT_THAT(why.what + why.to_do,
                  Not(AnyOf(HasSubstr("permission"), HasSubstr("protected"))));
      EXPECT_THAT(why.what, HasSubstr(thing));
    }
  }
}

}  // namespace
}  // namespace steadyrest::kernel::file
