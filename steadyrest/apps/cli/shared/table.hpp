// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace steadyrest::apps::cli {

/// A short table for people: columns as wide as their widest cell, the first column to the left,
/// the others to the right. Counts characters, not bytes (µ, ε, °).
class Table {
 public:
  explicit Table(std::vector<std::string> head = {}) : head_(std::move(head)) {}
  Table& row(std::vector<std::string> cells) {
    rows_.push_back(std::move(cells));
    return *this;
  }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace steadyrest::apps::cli
