// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <sstream>

#include "program.hpp"
#include <gtest/gtest.h>

namespace steadyrest::test {
namespace {

/// The words below `Subcommands:`. Continuation lines of a description are indented further.
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

}  // namespace

std::string help_of(Words path) {
  path.emplace_back("--help");
  const Finished finished = run(path);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_TRUE(finished.err.empty()) << finished.err;
  return finished.out;
}

/// Verbs are the leaves of the tree of subcommands.
std::vector<Words> verbs(const Words& path) {
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

std::string joined(const Words& words) {
  std::string out;
  for (const std::string& word : words) {
    out += (out.empty() ? "" : " ") + word;
  }
  return out;
}

}  // namespace steadyrest::test
