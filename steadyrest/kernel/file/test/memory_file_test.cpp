// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/memory_file.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::kernel::file {
namespace {

TEST(MemoryFile, IsReadByItsNameAgainAndAgainAndIsGoneWithItsObject) {
  const std::string text(100'000, 'x');
  std::string path;
  {
    auto made = MemoryFile::make(text);
    ASSERT_TRUE(made.has_value());
    const MemoryFile file = std::move(*made);
    path = file.path();
    EXPECT_EQ(testing::text_of_file(path), text);
    EXPECT_EQ(testing::text_of_file(path), text);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace steadyrest::kernel::file
