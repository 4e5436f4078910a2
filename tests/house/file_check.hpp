// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rules.hpp"

/// The rules for one file under the root, each group in a source of its own.
namespace house {

/// The file, and what was found in it so far.
struct FileCheck {
  const SourceFile& file;
  const Rules& rules;
  std::string folder;   ///< under the root
  std::string blanked;  ///< the text without comments and literals
  std::vector<Violation> found;

  void report(std::string_view rule, std::size_t line, std::string what);
};

/// place, floor, half, shelf, quoted-include; and the headers of in-cycle.
void check_includes(FileCheck& check);

/// in-cycle: words, loops, `noexcept`.
void check_code_in_cycle(FileCheck& check);

void check_namespaces(FileCheck& check);

}  // namespace house
