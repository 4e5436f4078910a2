// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/file/unified_diff.hpp>

namespace steadyrest::kernel::file {
namespace {

/// Lines of few words, so that many are equal.
rc::Gen<std::string> any_lines() {
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(
                          rc::gen::container<std::string>(rc::gen::element('a', 'b', ' '))),
                      [](const std::vector<std::string>& lines) {
                        std::string out;
                        for (const std::string& line : lines) {
                          out += line + "\n";
                        }
                        return out;
                      });
}

// `patch` is the judge of the diff.
TEST(UnifiedDiff, IsWhatPatchReads) {
  if (std::system("command -v patch >/dev/null") != 0) {
    GTEST_SKIP() << "patch is not installed";
  }
  EXPECT_EQ(unified_diff("f", "same\n", "same\n"), "");
  EXPECT_EQ(unified_diff("f", "a\nb\n", "a\nc\n"), "--- f\n+++ f\n@@ -1,2 +1,2 @@\n a\n-b\n+c\n");
  EXPECT_TRUE(rc::check([] {
    const testing::OwnFolder folder;
    const std::string before = "0\n1\n2\n3\n4\n5\n" + *any_lines() + "6\n7\n8\n9\n10\n11\n12\n13\n";
    std::string after = before;
    after.insert(after.find("2\n"), "new\n");
    if (*rc::gen::arbitrary<bool>()) {
      after += *rc::gen::element<std::string>("end", "end\n");
      after.erase(after.find("9\n"), 2);
    }
    folder.file("f", before);
    folder.file("diff", unified_diff("f", before, after));
    const std::string command =
        "cd '" + folder.path().string() + "' && patch -s -F0 -p0 <diff >/dev/null 2>&1";
    RC_ASSERT(std::system(command.c_str()) == 0);
    RC_ASSERT(testing::text_of_file(folder.at("f")) == after);
  }));
}

TEST(UnifiedDiff, NamesATextThatIsNotThere) {
  EXPECT_EQ(unified_diff("f", {}, "a\n"), "--- /dev/null\n+++ f\n@@ -0,0 +1,1 @@\n+a\n");
}

}  // namespace
}  // namespace steadyrest::kernel::file
