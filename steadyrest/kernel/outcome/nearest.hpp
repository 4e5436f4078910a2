// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace steadyrest::kernel::outcome {

/// The candidate that `word` was probably meant to be: smallest edit distance (insert, delete,
/// replace, swap of neighbours), at most a third of the word's length plus one. Empty if there is
/// none.
[[nodiscard]] std::string_view nearest(std::string_view word,
                                       std::span<const std::string_view> candidates);

/// What to do about an unknown word: `write NEAREST if that is meant`, else `otherwise`.
[[nodiscard]] std::string meant(std::string_view word, std::span<const std::string_view> candidates,
                                std::string otherwise);

}  // namespace steadyrest::kernel::outcome
