// SPDX-License-Identifier: Apache-2.0
// What a rounding must be, whatever its moves are: it has its radius, begins and ends on them, and
// goes on in their directions.
#include <cmath>
#include <cstdint>
#include <random>

#include <rapidcheck.h>

#include <steadyrest/nc/interpret/motion/contour_corners.hpp>
#include <steadyrest/nc/interpret/motion/plane_element.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr PlaneAxes kXy = axes_of(Plane::xy);

class RandomMoves {
 public:
  explicit RandomMoves(std::uint32_t seed) : random_(seed) {}

  double between(double from, double to) {
    return from + (to - from) * static_cast<double>(random_() % 1'000'000) / 1e6;
  }
  /// A line or an arc from `start`.
  Move next(const Axes& start) {
    Move move;
    move.start = start;
    move.end = start;
    move.feed_mm_s = 1.0;
    if (random_() % 2 == 0) {
      move.kind = MoveKind::linear;
      move.end[0] += between(-30, 30);
      move.end[1] += between(-30, 30);
      return move;
    }
    move.kind = MoveKind::arc;
    move.turns = random_() % 2 == 0 ? 1 : -1;
    move.normal = {0, 0, 1};
    move.centre_mm = {start[0] + between(-15, 15), start[1] + between(-15, 15), start[2]};
    const double angle = between(0.3, 6) * move.turns;
    const double x = start[0] - move.centre_mm[0];
    const double y = start[1] - move.centre_mm[1];
    move.end[0] = move.centre_mm[0] + x * std::cos(angle) - y * std::sin(angle);
    move.end[1] = move.centre_mm[1] + x * std::sin(angle) + y * std::cos(angle);
    return move;
  }

 private:
  std::mt19937 random_;
};

/// The direction of the way at one end.
PlanePoint way_at(const Move& move, bool at_end) {
  const PlaneElement element(move, kXy);
  return at_end ? element.end_tangent() : element.start_tangent();
}

void expect_smooth(const Move& before, const Move& after) {
  const PlanePoint a = way_at(before, true);
  const PlanePoint b = way_at(after, false);
  RC_ASSERT(before.end == after.start);
  RC_ASSERT(std::abs(a.first * b.second - a.second * b.first) < 1e-7);
  RC_ASSERT(a.first * b.first + a.second * b.second > 0.0);
}

double radius_at(const Move& arc, const Axes& point) {
  return std::hypot(point[0] - arc.centre_mm[0], point[1] - arc.centre_mm[1]);
}

TEST(ContourCorners, AreTangentialToBothMoves) {
  int rounded = 0;
  EXPECT_TRUE(rc::check([&rounded] {
    RandomMoves moves(*rc::gen::arbitrary<std::uint32_t>());
    Kept kept;
    ContourCorners corners;
    corners.send_to(kept, Plane::xy);
    const Move first = moves.next({1.0, 2.0, 3.0});
    const Move second = moves.next(first.end);
    const double radius = moves.between(0.01, 3);
    corners.on_move(first);
    corners.round(radius, false, 0.5, 7);
    corners.on_move(second);
    if (corners.fault() != ContourCorners::Fault::none) {
      return;
    }
    corners.on_event({.kind = EventKind::end});
    RC_ASSERT(kept.moves.size() == 3U);
    const Move& corner = kept.moves[1];
    RC_ASSERT(corner.line == 7U);
    RC_ASSERT(corner.feed_mm_s == 0.5);
    RC_ASSERT(std::abs(radius_at(corner, corner.start) - radius) < 1e-9);
    RC_ASSERT(std::abs(radius_at(corner, corner.end) - radius) < 1e-9);
    expect_smooth(kept.moves[0], corner);
    expect_smooth(corner, kept.moves[2]);
    // What is left of the moves has their own start, end and circle.
    RC_ASSERT(kept.moves[0].start == first.start);
    RC_ASSERT(kept.moves[2].end == second.end);
    if (first.kind == MoveKind::arc) {
      RC_ASSERT(std::abs(radius_at(first, corner.start) - radius_at(first, first.start)) < 1e-9);
    }
    if (second.kind == MoveKind::arc) {
      RC_ASSERT(std::abs(radius_at(second, corner.end) - radius_at(second, second.start)) < 1e-9);
    }
    ++rounded;
  }));
  EXPECT_GE(rounded, 5);
}

TEST(ContourCorners, NameWhatIsMissing) {
  using Fault = ContourCorners::Fault;
  const auto line = [](double x0, double y0, double x1, double y1) {
    Move move;
    move.kind = MoveKind::linear;
    move.start = {x0, y0};
    move.end = {x1, y1};
    return move;
  };
  const auto fault_of = [](const std::optional<Move>& first, const std::optional<Move>& second,
                           bool chamfer, double length) {
    Kept kept;
    ContourCorners corners;
    corners.send_to(kept, Plane::xy);
    if (first) {
      corners.on_move(*first);
    }
    corners.round(length, chamfer, 0.0, 1);
    if (second) {
      corners.on_move(*second);
    } else {
      corners.on_event({.kind = EventKind::end});
    }
    return corners.fault();
  };
  const Move first = line(0, 0, 10, 0);
  const Move second = line(10, 0, 10, 10);
  Move rapid = second;
  rapid.kind = MoveKind::rapid;
  Move down = second;
  down.end[2] = -1.0;
  EXPECT_EQ(fault_of(first, second, false, 10.0), Fault::none);
  EXPECT_EQ(fault_of(first, second, false, 10.1), Fault::does_not_fit);
  EXPECT_EQ(fault_of(first, second, true, 10.1), Fault::does_not_fit);
  EXPECT_EQ(fault_of({}, second, false, 1.0), Fault::nothing_before);
  EXPECT_EQ(fault_of(first, {}, false, 1.0), Fault::nothing_after);
  EXPECT_EQ(fault_of(first, rapid, false, 1.0), Fault::nothing_after);
  EXPECT_EQ(fault_of(first, down, true, 1.0), Fault::off_plane);
  EXPECT_EQ(fault_of(first, line(10, 0, 20, 0), false, 1.0), Fault::no_corner);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
