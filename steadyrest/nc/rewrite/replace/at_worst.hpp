// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::nc::rewrite {

/// Makes a changed program; where that is refused, once more with the blocks near the line that
/// the refusal names as they are (Stays::unproved), eight times as many each time. So the whole
/// program is refused only where none is left that could stay.
template <class Make>
[[nodiscard]] auto at_worst_they_stay(CutBlocks& blocks, const Make& make) -> decltype(make()) {
  constexpr std::size_t kMore = 8;
  auto made = make();
  // A disk that is full says nothing of any block.
  const auto refused = [&] {
    return !made && made.error().kind == kernel::outcome::Kind::bad_input;
  };
  for (std::size_t keep = 1;
       refused() && blocks.keep_near(static_cast<std::uint32_t>(made.error().line), keep) > 0;
       keep *= kMore) {
    made = make();
  }
  return made;
}

}  // namespace steadyrest::nc::rewrite
