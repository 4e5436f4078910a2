// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/provenance/builders_words.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::interpret {

using kernel::machine::BuildersWord;
using read::FlowKind;

const BuildersWord* BuildersWords::find(std::string_view name) const {
  const auto found = std::ranges::find_if(declared_, [&](const BuildersWord& one) {
    return std::ranges::equal(one.word, name, {}, {}, read::upper);
  });
  return found == declared_.end() ? nullptr : &*found;
}

const BuildersWord* BuildersWords::find(const read::Word& word) const {
  return word.letter == 0 ? find(word.name) : find(fmt::format("{}{}", word.letter, word.value));
}

std::span<const BuildersWord* const> BuildersWords::take(read::Block& block) {
  found_.clear();
  const FlowKind kind = block.flow().kind;
  if (kind == FlowKind::call || kind == FlowKind::cycle) {
    if (const BuildersWord* const call = find(block.flow().label.view()); call != nullptr) {
      found_.push_back(call);
      block.flow().kind = FlowKind::none;
    }
    return found_;
  }
  bool others = false;
  for (const read::Word& word : block.words()) {
    const BuildersWord* const one = find(word);
    if (one != nullptr) {
      found_.push_back(one);
    } else {
      const bool axis = word.letter == 0 || (Step::bit(word.letter) & kAxisMask) != 0;
      others = others || axis || word.letter == 'G' || word.letter == 'M';
    }
  }
  if (!found_.empty()) {
    block.drop([&](const read::Word& word) {
      return find(word) != nullptr || (!others && word.letter != 'N');
    });
  }
  return found_;
}

Effects effects_of(const BuildersWord& word) noexcept {
  Effects effects{.all = word.does == BuildersWord::Does::opaque};
  for (const char letter : word.axes) {
    effects.axes |= std::uint32_t{1} << kAxisLetters.find(letter);
  }
  return effects;
}

}  // namespace steadyrest::nc::interpret
