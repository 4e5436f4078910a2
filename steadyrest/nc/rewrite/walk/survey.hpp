// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>

namespace steadyrest::nc::rewrite {

/// What must be known about a whole program before a place in it can be judged.
struct Survey {
  /// Lines executed in a subprogram, a condition or a loop, or twice; one bit per line.
  std::vector<bool> repeated;
  /// From a tool change to the line that applies the tool length (G43, D), inclusive, counted in
  /// steps of the run.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> without_length;
  std::uint32_t end_line = 0;                 ///< the line that ends the program
  std::vector<std::string> subprogram_files;  ///< other files it calls
  /// The same for the other position of block delete, where the program has lines with `/`.
  std::shared_ptr<const Survey> other;

  /// Notes that `line` is executed, and whether it may run `again`; `seen` holds the lines so far.
  void mark(std::uint32_t line, std::vector<bool>& seen, bool again);
  [[nodiscard]] bool is_repeated(std::uint32_t line) const noexcept {
    return line < repeated.size() && repeated[line];
  }
};

/// Runs the program once, or with lines that begin with `/` twice: in both positions of the
/// operator's switch. Refuses what the interpreter refuses.
[[nodiscard]] kernel::outcome::Result<Survey> survey(const std::string& path,
                                                     const interpret::Config& config);

/// Block delete in its other position.
[[nodiscard]] interpret::Config switched(interpret::Config config);
/// A refusal from the run with the switch in the other position than configured.
[[nodiscard]] kernel::outcome::Refusal of_other_position(kernel::outcome::Refusal refusal,
                                                         const interpret::Config& config);

}  // namespace steadyrest::nc::rewrite
