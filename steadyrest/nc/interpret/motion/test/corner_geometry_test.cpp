// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/motion/corner_geometry.hpp>

// Closed forms: the tangent length of a rounding between lines is r·tan(φ/2), φ the change of
// direction. Beside arcs what makes a rounding one: its centre is r from both sides, its ends are
// on them, and it goes on where they go.
namespace steadyrest::nc::interpret {
namespace {

using Complex = std::complex<double>;

PlanePoint point(Complex c) {
  return {.first = c.real(), .second = c.imag()};
}
Complex complex(const PlanePoint& p) {
  return {p.first, p.second};
}
CornerSide line(Complex from, Complex to) {
  return {.start = point(from), .end = point(to), .arc = false, .centre = {}, .clockwise = false};
}

TEST(CornerGeometry, OfARightAngleIsWhatAnyoneDraws) {
  const CornerSide along = line({0, 0}, {10, 0});
  const CornerSide up = line({10, 0}, {10, 10});
  const auto round = rounding(along, up, 2.0);
  ASSERT_TRUE(round);
  EXPECT_NEAR(std::abs(complex(round->from) - Complex(8, 0)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(complex(round->to) - Complex(10, 2)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(complex(round->centre) - Complex(8, 2)), 0.0, 1e-12);
  EXPECT_FALSE(round->clockwise);
  const auto cut = chamfer(along, up, 2.0);
  ASSERT_TRUE(cut);
  EXPECT_EQ(complex(cut->from), Complex(8, 0));
  EXPECT_EQ(complex(cut->to), Complex(10, 2));
}

TEST(CornerGeometry, SaysWhatHasNoCorner) {
  const CornerSide along = line({0, 0}, {10, 0});
  EXPECT_EQ(rounding(along, line({10, 0}, {20, 0.1}), 1.0).error(), CornerFault::straight);
  EXPECT_EQ(chamfer(along, line({10, 0}, {5, 0}), 1.0).error(), CornerFault::reversal);
  EXPECT_EQ(rounding(along, line({10, 0}, {10, 3}), 4.0).error(), CornerFault::too_large);
  EXPECT_EQ(chamfer(along, line({10, 0}, {10, 3}), 4.0).error(), CornerFault::too_large);
  EXPECT_TRUE(rounding(along, line({10, 0}, {10, 3}), 3.0)) << "the whole side";
}

TEST(CornerGeometry, BetweenRandomLinesFollowsTheTangentLength) {
  std::mt19937 random(7);
  std::uniform_real_distribution<> angle(-3.0, 3.0);
  std::uniform_real_distribution<> size(0.1, 5.0);
  const int count = kernel::testing::kSanitized ? 100 : 10'000;
  for (int i = 0; i < count; ++i) {
    const double heading = angle(random);
    const double turn = angle(random);
    if (std::abs(turn) < 0.02) {
      continue;
    }
    const Complex corner(size(random), size(random));
    const Complex in = std::polar(1.0, heading);
    const Complex out = std::polar(1.0, heading + turn);
    const double radius = size(random);
    const double tangent = radius * std::tan(std::abs(turn) / 2.0);
    const CornerSide first = line(corner - in * (tangent + 1.0), corner);
    const CornerSide second = line(corner, corner + out * (tangent + 1.0));
    const auto found = rounding(first, second, radius);
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR(std::abs(complex(found->from) - (corner - in * tangent)), 0.0,
                1e-9 * tangent + 1e-9);
    EXPECT_NEAR(std::abs(complex(found->to) - (corner + out * tangent)), 0.0,
                1e-9 * tangent + 1e-9);
    EXPECT_EQ(found->clockwise, turn < 0.0);
    EXPECT_EQ(rounding(line(corner - in * (tangent * 0.99), corner), second, radius).error(),
              CornerFault::too_large);
  }
}

/// A side that ends (or begins) at the corner with this direction of travel.
struct Bent {
  CornerSide side;
  Complex travel;
};

class Sides {
 public:
  explicit Sides(unsigned seed) : random_(seed) {}

  Bent make(Complex corner, bool ends_here) {
    const Complex travel = std::polar(1.0, real(-3.1, 3.1));
    if (real(0.0, 1.0) < 0.3) {
      const Complex far = corner + (ends_here ? -travel : travel) * real(4.0, 9.0);
      return {ends_here ? line(far, corner) : line(corner, far), travel};
    }
    const double radius = real(3.0, 20.0);
    const bool clockwise = real(0.0, 1.0) < 0.5;
    // The centre is to the left of a counter-clockwise travel.
    const Complex centre = corner + travel * Complex(0.0, clockwise ? -radius : radius);
    const double sweep = real(0.5, 2.5) * (clockwise ? -1.0 : 1.0) * (ends_here ? -1.0 : 1.0);
    const Complex far = centre + (corner - centre) * std::polar(1.0, sweep);
    return {{.start = point(ends_here ? far : corner),
             .end = point(ends_here ? corner : far),
             .arc = true,
             .centre = point(centre),
             .clockwise = clockwise},
            travel};
  }

 private:
  double real(double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random_);
  }
  std::mt19937 random_;
};

Complex travel_of(const CornerSide& side, Complex at) {
  if (!side.arc) {
    const Complex way = complex(side.end) - complex(side.start);
    return way / std::abs(way);
  }
  const Complex radius = (at - complex(side.centre)) / std::abs(at - complex(side.centre));
  return radius * Complex(0.0, side.clockwise ? -1.0 : 1.0);
}

TEST(CornerGeometry, BesideArcsIsTangentToBothSides) {
  const unsigned count = kernel::testing::kSanitized ? 100 : 20'000;
  int rounded = 0;
  for (unsigned seed = 1; seed <= count; ++seed) {
    Sides sides(seed);
    const Complex corner(1.0, 2.0);
    const Bent first = sides.make(corner, true);
    const Bent second = sides.make(corner, false);
    constexpr double kRadius = 0.4;
    const auto found = rounding(first.side, second.side, kRadius);
    if (!found) {
      continue;
    }
    ++rounded;
    const Complex centre = complex(found->centre);
    const double turn = std::arg(second.travel / first.travel);
    EXPECT_EQ(found->clockwise, turn < 0.0);
    for (const auto& [side, at] : {std::pair{first.side, complex(found->from)},
                                   std::pair{second.side, complex(found->to)}}) {
      ASSERT_NEAR(std::abs(at - centre), kRadius, 1e-7) << seed;
      const Complex around = (at - centre) / kRadius * Complex(0.0, found->clockwise ? -1.0 : 1.0);
      ASSERT_NEAR(std::abs(around - travel_of(side, at)), 0.0, 1e-6) << seed;
      if (side.arc) {
        ASSERT_NEAR(std::abs(at - complex(side.centre)),
                    std::abs(complex(side.start) - complex(side.centre)), 1e-9);
      }
    }
  }
  EXPECT_GT(rounded, static_cast<int>(count) / 2);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
