// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/kernel/machine/program.hpp>
#include <steadyrest/nc/interpret/provenance/effects.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// The words of a block that `[program.words]` of the machine file declares.
///
/// A declared word is taken out of its block, and the others act as if it were not there. Where no
/// other G or M word and no axis is left, the letters that remain are its arguments (`G187 P2`),
/// and go with it. A call by a declared name is no call.
class BuildersWords {
 public:
  explicit BuildersWords(std::vector<kernel::machine::BuildersWord> declared) noexcept
      : declared_(std::move(declared)) {}
  [[nodiscard]] bool none() const noexcept { return declared_.empty(); }
  /// Those of this block, which is without them afterwards.
  [[nodiscard]] std::span<const kernel::machine::BuildersWord* const> take(read::Block& block);

 private:
  [[nodiscard]] const kernel::machine::BuildersWord* find(const read::Word& word) const;
  [[nodiscard]] const kernel::machine::BuildersWord* find(std::string_view name) const;

  std::vector<kernel::machine::BuildersWord> declared_;
  std::vector<const kernel::machine::BuildersWord*> found_;
};

/// What a declared word may change.
[[nodiscard]] Effects effects_of(const kernel::machine::BuildersWord& word) noexcept;

}  // namespace steadyrest::nc::interpret
