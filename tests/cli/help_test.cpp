// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steadyrest::test {
namespace {

using Words = std::vector<std::string>;

std::string help_of(Words path) {
  path.emplace_back("--help");
  const Finished finished = run(path);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_TRUE(finished.err.empty()) << finished.err;
  return finished.out;
}

/// The words below `Subcommands:`.
Words children(const std::string& help) {
  Words names;
  std::istringstream in(help);
  std::string line;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line == "Subcommands:") {
      inside = true;
    } else if (inside && line.starts_with("  ") && line.size() > 2 && line[2] != ' ') {
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    } else if (line.empty()) {
      inside = false;
    }
  }
  return names;
}

/// Every path that leads to a verb.
std::vector<Words> verbs(const Words& path = {}) {
  std::vector<Words> out;
  const Words names = children(help_of(path));
  if (names.empty()) {
    out.push_back(path);
  }
  for (const std::string& name : names) {
    Words longer = path;
    longer.push_back(name);
    for (Words& verb : verbs(longer)) {
      out.push_back(std::move(verb));
    }
  }
  return out;
}

/// The commands below `Example:`, without the program's name.
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

TEST(Help, ShowsTheVerbs) {
  EXPECT_THAT(verbs(), testing::IsSupersetOf({Words{"doctor"}, Words{"contour", "limit"}}));
}

TEST(Help, EveryVerbTakesJson) {
  for (const Words& verb : verbs()) {
    EXPECT_THAT(help_of(verb), testing::HasSubstr("--json")) << verb.back();
  }
}

TEST(Help, EveryVerbEndsWithAnExampleThatWorks) {
  for (const Words& verb : verbs()) {
    const Words commands = examples(help_of(verb));
    EXPECT_FALSE(commands.empty()) << verb.back();
    for (const std::string& command : commands) {
      const Finished finished = run_line(command);
      EXPECT_EQ(finished.code, 0) << command << "\n" << finished.err;
      EXPECT_FALSE(finished.out.empty()) << command;
    }
  }
}

}  // namespace
}  // namespace steadyrest::test
