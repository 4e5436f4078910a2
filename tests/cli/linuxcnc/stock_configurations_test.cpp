// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include "linuxcnc/linuxcnc_files.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/setup.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// What the verbs do, on every configuration that the LinuxCNC package has; without the program, as
// there are hundreds.
namespace steadyrest::test {
namespace {

namespace fs = std::filesystem;
namespace config = adapters::linuxcnc::config;
using kernel::outcome::Refusal;

class StockConfigurations : public testing::Test {
 protected:
  void SetUp() override {
    if (stock_inis().empty()) {
      GTEST_SKIP() << "the sample configurations of LinuxCNC are not installed";
    }
  }
};

/// A refusal says where, what and what to do.
void expect_clear(const Refusal& refusal, const fs::path& ini) {
  EXPECT_THAT(refusal.file, testing::MatchesRegex("/.*[.](ini|inc|hal)")) << ini;
  EXPECT_FALSE(refusal.what.empty()) << ini;
  EXPECT_FALSE(refusal.to_do.empty()) << ini;
}

TEST_F(StockConfigurations, GiveAMachineFileThatReadsBackOrARefusal) {
  std::size_t made = 0;
  std::size_t tried = 0;
  for (const fs::path& path : kernel::testing::cases(stock_inis(), 40)) {
    ++tried;
    const auto ini = config::IniFile::read(path.string());
    const auto machine = ini ? config::configuration_of(*ini) : std::unexpected(ini.error());
    const auto text = machine ? config::machine_text(*ini, *machine, nullptr, {})
                              : std::unexpected(machine.error());
    if (!text) {
      expect_clear(text.error(), path);
      continue;
    }
    const auto read = passport::parse(text->text, "machine.toml");
    ASSERT_TRUE(read) << path << read.error().what;
    EXPECT_EQ(read->port, kernel::machine::PortKind::linuxcnc);
    ++made;
  }
  // Robots, deltas and nine-axis demos are refused.
  EXPECT_GT(made, tried / 2);
}

TEST_F(StockConfigurations, AreSetUpAndUndoneByteForByteOrRefused) {
  std::size_t made = 0;
  std::size_t tried = 0;
  for (const fs::path& path : kernel::testing::cases(stock_inis(), 10)) {
    ++tried;
    const Scratch scratch;
    for (const auto& entry : fs::directory_iterator(path.parent_path())) {
      if (entry.is_regular_file()) {
        fs::copy_file(entry.path(), scratch.path() / entry.path().filename());
      }
    }
    const FolderTexts before = texts_in(scratch.path());
    const std::string copy = scratch.at(path.filename().string());
    const auto plan = config::plan_setup(copy, {});
    if (!plan) {
      expect_clear(plan.error(), path);
      EXPECT_EQ(texts_in(scratch.path()), before) << path;
      continue;
    }
    ++made;
    ASSERT_TRUE(config::carry_out(*plan)) << path;
    EXPECT_NE(texts_in(scratch.path()), before) << path;
    EXPECT_FALSE(config::plan_setup(copy, {})) << path << ": twice";
    const auto undo = config::plan_undo(copy);
    ASSERT_TRUE(undo) << path << undo.error().what;
    ASSERT_TRUE(config::carry_out(*undo)) << path;
    EXPECT_EQ(texts_in(scratch.path()), before) << path;
  }
  // A third is in Tcl.
  EXPECT_GT(made, kernel::testing::kSanitized ? 0U : tried / 3);
}

}  // namespace
}  // namespace steadyrest::test
