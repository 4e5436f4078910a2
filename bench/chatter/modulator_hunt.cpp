// SPDX-License-Identifier: Apache-2.0
// Hunts for a change of parameters after which the modulator leaves its limits or its override word
// is unsafe: steadyrest_modulator_hunt [CHANGES] [SEED].
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <fmt/core.h>

#include <steadyrest/chatter/online/test/modulator_hunt.hpp>

int main(int argc, char** argv) {
  constexpr std::uint64_t kPart = 1'000'000;
  const std::uint64_t changes = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000'000ULL;
  std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  steadyrest::chatter::online::test::Hunt all;
  // Seeds run on with the parts, so any first fault can be repeated from its seed alone.
  while (all.changes < changes) {
    const auto part =
        steadyrest::chatter::online::test::hunt(seed, std::min(kPart, changes - all.changes));
    seed += kPart;
    if (!part.first.empty()) {
      fmt::print("{}\n", part.first);
    }
    all.add(part);
    fmt::print(stderr, "{:.1f} % \r",
               100.0 * static_cast<double>(all.changes) / static_cast<double>(changes));
  }
  fmt::print(
      "{} changes, {} wishes, {} changes of a masked word: {} outputs outside, {} jumps of the "
      "phase, {} of the speed, {} above the feed per tooth, {} invalid codes, {} words outside of "
      "[from, to]\n",
      all.changes, all.wishes, all.words, all.outside, all.phase_jumps, all.speed_jumps,
      all.feed_per_tooth, all.invalid_codes, all.words_outside);
  return all.faults() == 0 ? 0 : 1;
}
