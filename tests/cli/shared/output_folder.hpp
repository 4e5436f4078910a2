// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "output_rows.hpp"
#include "scratch.hpp"

namespace steadyrest::test {

using Texts = std::map<std::string, std::string>;  ///< content by path within the folder

/// A folder with a copy of examples/, in which a row's command runs.
class OutputFolder {
 public:
  explicit OutputFolder(const OutputRow& row);

  [[nodiscard]] std::string path() const { return scratch_.at(""); }
  [[nodiscard]] std::string at(const std::string& name) const { return scratch_.at(name); }
  /// The row's command; an output whose flag is in `instead` gets that value.
  [[nodiscard]] std::vector<std::string> command(const Texts& instead = {}) const;
  /// Paths of everything the row writes.
  [[nodiscard]] std::vector<std::string> outputs() const;
  /// Files and their content, inside `examples/` and outside it.
  [[nodiscard]] Texts results() const;
  [[nodiscard]] Texts examples() const;
  /// Makes `results()` these, folders included.
  void place(const Texts& results) const;
  void clear() const { place({}); }

 private:
  const OutputRow& row_;
  Scratch scratch_;
};

}  // namespace steadyrest::test
