// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "rules.hpp"
#include <toml++/toml.h>

// The rules as data, so that a new folder is a line in floors.toml and not in a program.
namespace house {
namespace {

std::vector<std::string> strings(const toml::node_view<const toml::node>& node) {
  std::vector<std::string> out;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array) {
      out.push_back(item.value_or<std::string>(""));
    }
  }
  return out;
}

}  // namespace

std::expected<Rules, std::string> read_rules(std::string_view toml_text) {
  try {
    const toml::table table = toml::parse(toml_text);
    Rules rules;
    rules.root = table["root"].value_or<std::string>("");
    rules.most_files = table["size"]["most_files"].value_or<std::size_t>(0);
    rules.most_lines = table["size"]["most_lines"].value_or<std::size_t>(0);
    if (const toml::array* places = table["place"].as_array()) {
      for (const toml::node& node : *places) {
        const toml::table& entry = *node.as_table();
        rules.places.push_back({entry["folder"].value_or<std::string>(""),
                                entry["floor"].value_or(0), strings(entry["includes"]),
                                strings(entry["shelves"])});
      }
    }
    rules.in_cycle_folders = strings(table["in_cycle"]["folders"]);
    rules.in_cycle_headers = strings(table["in_cycle"]["headers"]);
    rules.in_cycle_words = strings(table["in_cycle"]["words"]);
    rules.noexcept_functions = strings(table["in_cycle"]["noexcept_functions"]);
    rules.stage_folder = table["stages"]["folder"].value_or<std::string>("");
    rules.stage_shape = strings(table["stages"]["shape"]);
    // An empty list would let everything pass.
    if (rules.root.empty() || rules.places.empty() || rules.in_cycle_folders.empty() ||
        rules.most_files == 0 || rules.most_lines == 0) {
      return std::unexpected("root, both of [size], [[place]] and in_cycle.folders are needed");
    }
    return rules;
  } catch (const toml::parse_error& error) {
    return std::unexpected(std::string(error.description()));
  }
}

}  // namespace house
