// SPDX-License-Identifier: Apache-2.0
// Random parts in Klartext against their own moves in plain G code; RC_PARAMS turns their number
// up.
#include <algorithm>
#include <cmath>
#include <span>

#include <rapidcheck.h>

#include <steadyrest/nc/interpret/test/heidenhain/heidenhain.hpp>
#include <steadyrest/nc/interpret/test/heidenhain/random_part.hpp>

namespace steadyrest::nc::interpret {
namespace {

bool near_each(std::span<const double> a, std::span<const double> b) {
  constexpr double kEqual = 1e-9;
  return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) <= kEqual; });
}

bool same_move(const Move& a, const Move& b) {
  return a.kind == b.kind && near_each(a.start, b.start) && near_each(a.end, b.end) &&
         std::abs(a.feed_mm_s - b.feed_mm_s) < 1e-9 && a.dwell_s == b.dwell_s &&
         a.turns == b.turns && near_each(a.centre_mm, b.centre_mm);
}

TEST(HeidenhainRandom, PartsMoveAsTheirTwinsInGCode) {
  EXPECT_TRUE(rc::check([] {
    const test::RandomPart part(*rc::gen::arbitrary<std::uint32_t>());
    const std::string text = test::klartext(part.klartext());
    Kept ours;
    Kept theirs;
    const auto report = run_text(text, test::heidenhain(), ours);
    const auto twin = run_text(part.twin() + "M2\n", {}, theirs);
    RC_LOG(text + "---\n" + part.twin());
    RC_ASSERT(twin->refused.empty());
    RC_ASSERT(report->refused.empty());
    RC_ASSERT(ours.moves.size() == theirs.moves.size());
    for (std::size_t i = 0; i < ours.moves.size(); ++i) {
      RC_LOG(fmt::format("move {} of line {}", i, ours.moves[i].line));
      RC_ASSERT(same_move(ours.moves[i], theirs.moves[i]));
    }
  }));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
