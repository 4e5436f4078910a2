// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "rules.hpp"

/// Sources in memory only, and what the rules find in them.
namespace house {

inline const Rules& rules() {
  static const Rules kRules = [] {
    std::ifstream in(STEADYREST_SOURCE_DIR "/tests/house/floors.toml");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return read_rules(text).value();
  }();
  return kRules;
}

inline constexpr std::string_view kSpdx = "// SPDX-License-Identifier: Apache-2.0\n";

inline std::string namespace_of(std::string path) {
  path = std::string(folder_of(path));
  if (path.ends_with("/test")) {
    path.resize(path.size() - 5);
  }
  for (std::size_t at = path.find('/'); at != std::string::npos; at = path.find('/')) {
    path.replace(at, 1, "::");
  }
  return path;
}

/// A file that breaks no rule except by `body`, which starts on line 2, after the licence line.
inline SourceFile file(const std::string& path, const std::string& body) {
  return {path, std::string(kSpdx) + body + "\nnamespace " + namespace_of(path) + " {}\n"};
}

/// Each violation as `rule:line`.
inline std::vector<std::string> found(const SourceFile& source) {
  std::vector<std::string> out;
  for (const Violation& violation : check_file(source, rules())) {
    out.push_back(violation.rule + ":" + std::to_string(violation.line));
  }
  return out;
}

inline std::vector<std::string> found(const std::string& path, const std::string& body) {
  return found(file(path, body));
}

/// Of a file on a shelf of the chatter room's offline half.
inline std::vector<std::string> shelved(const std::string& path, const std::string& body) {
  return found({path, std::string(kSpdx) + body + "\nnamespace steadyrest::chatter::offline {}\n"});
}

}  // namespace house
