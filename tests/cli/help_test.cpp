// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <sstream>
#include <string>
#include <vector>

#include "live/live_layer.hpp"
#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::test {
namespace {

/// The commands below `Example:`, without the program's name; a verb may have several.
Words examples(const std::string& help) {
  const std::string head = "Example:\n";
  const std::size_t at = help.find(head);
  Words out;
  std::istringstream in(at == std::string::npos ? "" : help.substr(at + head.size()));
  std::string line;
  const std::string program = "  steadyrest ";
  while (std::getline(in, line)) {
    if (line.starts_with(program)) {
      out.push_back(line.substr(program.size()));
    }
  }
  return out;
}

// Two verbs of different depth, so that the walk through the help works at all.
TEST(Help, ShowsTheVerbs) {
  EXPECT_THAT(verbs(), testing::IsSupersetOf({Words{"doctor"}, Words{"contour", "limit"}}));
}

TEST(Help, EveryVerbTakesJson) {
  for (const Words& verb : verbs()) {
    EXPECT_THAT(help_of(verb), testing::HasSubstr("--json")) << verb.back();
  }
}

// Eleven verbs make reports; a twelfth must show it in its help.
TEST(Help, EveryVerbWithAReportShowsHowToGetIt) {
  std::size_t reports = 0;
  for (const Words& verb : verbs()) {
    const std::string help = help_of(verb);
    if (help.find("--report DIR") == std::string::npos) {
      continue;
    }
    ++reports;
    EXPECT_THAT(examples(help), testing::Contains(testing::HasSubstr(" --report "))) << verb.back();
  }
  EXPECT_EQ(reports, 11U);
}

// The examples of --help are run as they are written: a reader copies them.
TEST(Help, EveryVerbEndsWithAnExampleThatWorks) {
  const Scratch own;  // for the accounts
  // For the verbs that ask a running one; it ends with its program, and examples may be slow.
  const LiveLayer layer(
      "observe", {}, own.file("waits.mpf", "G71 G90\nG0 X0 Y0 Z0\nG1 X1 F1000\nG4 F3600\nM30\n"));
  ::setenv("XDG_CONFIG_HOME", own.at("").c_str(), 1);
  const std::string password = own.file("password", "correct horse\n");
  for (const Words& verb : verbs()) {
    const Words commands = examples(help_of(verb));
    EXPECT_FALSE(commands.empty()) << verb.back();
    for (const std::string& command : kernel::testing::cases(commands)) {
      const Finished finished = run_line_on(command, password);
      EXPECT_EQ(finished.code, 0) << command << "\n" << finished.err;
      EXPECT_FALSE(finished.out.empty()) << command;
    }
  }
  ::unsetenv("XDG_CONFIG_HOME");
}

}  // namespace
}  // namespace steadyrest::test
