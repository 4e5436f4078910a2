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

/// What must be known of a whole program before a place in it can be judged.
struct Survey {
  /// Lines that are executed in a subprogram, a condition or a loop, or twice; a bit for each line.
  std::vector<bool> repeated;
  /// From a tool change to the line that puts the tool's length on (G43, D), both included,
  /// counted in steps of the run.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> without_length;
  std::uint32_t end_line = 0;                 ///< the line that ends the program
  std::vector<std::string> subprogram_files;  ///< other files that it calls
  /// The same with block delete in its other position, where the program has lines with `/`.
  std::shared_ptr<const Survey> other;

  /// `line` is executed, perhaps where it may be executed `again`; `seen` keeps what was.
  void mark(std::uint32_t line, std::vector<bool>& seen, bool again);
  [[nodiscard]] bool is_repeated(std::uint32_t line) const noexcept {
    return line < repeated.size() && repeated[line];
  }
};

/// Runs the program once, with lines that begin with `/` twice: in both positions of the operator's
/// switch. Refused: what the interpreter refuses.
[[nodiscard]] kernel::outcome::Result<Survey> survey(const std::string& path,
                                                     const interpret::Config& config);

/// Block delete in its other position.
[[nodiscard]] interpret::Config switched(interpret::Config config);
/// What was refused with the switch in the other position than the configuration has it.
[[nodiscard]] kernel::outcome::Refusal of_other_position(kernel::outcome::Refusal refusal,
                                                         const interpret::Config& config);

}  // namespace steadyrest::nc::rewrite
