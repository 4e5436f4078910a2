// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/nearest.hpp>

namespace steadyrest::kernel::outcome {
namespace {

// Words of files and of the command line are short; longer ones are no misspelling of any key.
constexpr std::size_t kLongestWord = 64;

/// Optimal string alignment distance: insertions, deletions, replacements and swapped neighbours,
/// the common typing errors, count one step each. Three rows of the table are enough, since a swap
/// looks two rows back.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    above[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replace, above[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.empty() || word.size() > kLongestWord) {
    return {};
  }
  std::string_view best;
  // A third of the letters may be wrong, plus one; beyond that a suggestion would mislead.
  std::size_t best_distance = word.size() / 3 + 2;
  for (const std::string_view candidate : candidates) {
    const std::size_t d = distance(word, candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

// The suggestion, or else the caller's own advice.
std::string meant(std::string_view word, std::span<const std::string_view> candidates,
                  std::string otherwise) {
  const std::string_view close = nearest(word, candidates);
  return close.empty() ? std::move(otherwise)
                       : "write " + std::string(close) + " if that is what you mean";
}

}  // namespace steadyrest::kernel::outcome
