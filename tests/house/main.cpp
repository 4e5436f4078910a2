// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "rules.hpp"
#include <fmt/format.h>
#include <fmt/ostream.h>

/// house_check ROOT FLOORS.toml [SIZE_REPORT]: checks the tree under ROOT; exit code 1 and one line
/// for each violation (FILE:LINE: what [rule]), so that an editor can jump there.
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_checked(const fs::path& path) {
  static constexpr std::array kEndings = {".hpp", ".cpp", ".h",  ".S",  ".cmake",
                                          ".sh",  ".ts",  ".py", ".mjs"};
  return path.filename() == "CMakeLists.txt" ||
         std::ranges::find(kEndings, path.extension().string()) != kEndings.end();
}

/// Only handwritten files; build folders and packages are not ours.
std::vector<house::SourceFile> read_tree(const fs::path& root) {
  static constexpr std::array kFolders = {"steadyrest", "tests",   "bench",   "examples",
                                          "cmake",      "scripts", "web/src", "web/test"};
  std::vector<house::SourceFile> tree;
  for (const char* folder : kFolders) {
    if (!fs::is_directory(root / folder)) {
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string relative = fs::relative(entry.path(), root).generic_string();
      // The fixtures of this very check are meant to break it.
      if (entry.is_regular_file() && is_checked(entry.path()) &&
          !relative.starts_with("tests/house/fixtures/") &&
          relative.find("/node_modules/") == std::string::npos) {
        tree.push_back({relative, read(entry.path())});
      }
    }
  }
  std::ranges::sort(tree, {}, &house::SourceFile::path);
  return tree;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) {
    fmt::print(stderr, "usage: house_check ROOT FLOORS.toml [SIZE_REPORT]\n");
    return 2;
  }
  const auto rules = house::read_rules(read(arguments[1]));
  if (!rules) {
    fmt::print(stderr, "{}: {}\n", arguments[1], rules.error());
    return 2;
  }
  const auto tree = read_tree(arguments[0]);
  if (arguments.size() > 2) {
    std::ofstream(arguments[2]) << house::size_report(tree, *rules);
  }
  const auto violations = house::check_tree(tree, *rules);
  for (const house::Violation& violation : violations) {
    fmt::print(stderr, "{}/{}:{}: {} [{}]\n", arguments[0], violation.path, violation.line,
               violation.what, violation.rule);
  }
  fmt::print("house: {} files, {} violations\n", tree.size(), violations.size());
  return violations.empty() && !tree.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "house_check: {}\n", error.what());
    return 2;
  }
}
