// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "source.hpp"

namespace house {

/// One entry of floors.toml.
struct Place {
  std::string folder;
  int floor = 0;
  std::vector<std::string> includes;
  std::vector<std::string> shelves;  ///< its folders, lowest first; anything outside them is above
};

/// floors.toml as values.
struct Rules {
  std::string root;
  std::size_t most_files = 0;  ///< in a folder
  std::size_t most_lines = 0;  ///< in a file
  std::vector<Place> places;
  std::vector<std::string> in_cycle_folders;
  std::vector<std::string> in_cycle_headers;
  std::vector<std::string> in_cycle_words;
  std::vector<std::string> noexcept_functions;
  std::string stage_folder;
  std::vector<std::string> stage_shape;  ///< text that each stage's class holds
};

[[nodiscard]] std::expected<Rules, std::string> read_rules(std::string_view toml_text);

struct Violation {
  std::string rule;  ///< floor, half, shelf, crowded, long-file, in-cycle, namespace, spdx,
                     ///< quoted-include, place, shared-data, stage, unbuilt
  std::string path;
  std::size_t line = 0;
  std::string what;
};

/// Violations that can be seen in a single file.
[[nodiscard]] std::vector<Violation> check_file(const SourceFile& file, const Rules& rules);

/// Sources under the root that no CMakeLists.txt above them names: code that is never built.
[[nodiscard]] std::vector<Violation> check_built(const std::vector<SourceFile>& tree,
                                                 const Rules& rules);

/// Folders with more files than one can look through; `x.hpp` and `x.cpp` count as one.
[[nodiscard]] std::vector<Violation> check_crowded(const std::vector<SourceFile>& tree,
                                                   const Rules& rules);

/// Classes with an update() that are members in the stages' folder and lack a part of the shape.
[[nodiscard]] std::vector<Violation> check_stages(const std::vector<SourceFile>& tree,
                                                  const Rules& rules);

/// All rules over all files.
[[nodiscard]] std::vector<Violation> check_tree(const std::vector<SourceFile>& tree,
                                                const Rules& rules);

/// Counts of files and lines, as text for people.
[[nodiscard]] std::string size_report(const std::vector<SourceFile>& tree, const Rules& rules);

}  // namespace house
