// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/reference.hpp>

// The page in docs/ is generated; an edit of the schema without it, or of the page by hand, shows
// here.
namespace steadyrest::passport {
namespace {

TEST(MachineReference, PageIsUpToDate) {
  std::ifstream in(STEADYREST_SOURCE_DIR "/docs/machine-file.md");
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(page == reference_page())
      << "run: cmake --build --preset release --target machine_reference";
}

}  // namespace
}  // namespace steadyrest::passport
