// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/frf.hpp>

namespace steadyrest::chatter::offline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Each file says `refuse LINE: words of the refusal`: CSV in its first line, which is a comment,
/// universal files in a title. Empty files cannot.
TEST(FrfCorpus, EveryFileIsRefusedWhereItSays) {
  std::set<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STEADYREST_SOURCE_DIR) / "tests/refused/frf")) {
    files.insert(entry.path());
  }
  EXPECT_GT(files.size(), 60U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename());
    const auto read = read_frf(file.string());
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().file, file.string());
    EXPECT_FALSE(read.error().to_do.empty());
    const std::string text = text_of(file);
    const std::size_t at = text.find("refuse ");
    if (at == std::string::npos) {
      EXPECT_TRUE(text.empty());
      continue;
    }
    const std::string said = text.substr(at + 7, text.find('\n', at) - at - 7);
    const std::size_t colon = said.find(": ");
    EXPECT_EQ(read.error().line, std::stoul(said)) << read.error().what;
    EXPECT_THAT(read.error().what, HasSubstr(said.substr(colon + 2)));
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline
