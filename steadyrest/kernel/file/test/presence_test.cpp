// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/presence.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::kernel::file {
namespace {

class WatchedFile : public ::testing::Test {
 protected:
  WatchedFile() { std::ofstream(name) << "text"; }
  testing::OwnFolder folder;
  std::string name = folder.at("file");
};

TEST_F(WatchedFile, IsRemovedAlsoWhereAnotherHasItsName) {
  const Presence presence(name);
  EXPECT_FALSE(presence.is_removed());
  std::filesystem::remove(name);
  std::ofstream(name) << "another";
  EXPECT_TRUE(presence.is_removed());
}

TEST_F(WatchedFile, IsNotRemovedWhereItWasMoved) {
  const Presence presence(name);
  std::filesystem::rename(name, folder.at("elsewhere"));
  EXPECT_FALSE(presence.is_removed());
}

TEST_F(WatchedFile, WasNeverThere) {
  const Presence presence(folder.at("none"));
  EXPECT_FALSE(presence.is_removed());
}

}  // namespace
}  // namespace steadyrest::kernel::file
