// SPDX-License-Identifier: Apache-2.0
// What parts teach that were cut on softer axes than the machine file says. Truth: the closed form
// of a circle on the axes as they are, less that on the axes of the file.
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/contour/offline/learn/test/recorded_part.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kTaughtRadius_mm = 10.0;
constexpr double kTaughtFeed_mm_s = 2400.0 / 60.0;
const char* const kTaughtCircle = "G0 X10 Y0\nG4 P0.5\nG3 X10 Y0 I-10 J0 P4 F2400\n";

/// A circle cut on axes of these gains; the machine file says 50 1/s.
LearntFrom taught_by(const std::vector<double>& gains_1_s) {
  const kernel::file::testing::OwnFolder folder;
  const auto machine = test::ideal_mill();
  const auto path = test::planned_moves(machine, kTaughtCircle);
  std::vector<CutPart> parts;
  for (const double gain_1_s : gains_1_s) {
    parts.push_back({.record = test::recorded_part(machine, path, gain_1_s),
                     .program = folder.file("part.ngc", test::exact_program(kTaughtCircle))});
  }
  return learn_from(parts, {.machine = machine,
                            .config = {},
                            .original = path,
                            .model = servo_models(machine.axes)})
      .value();
}

double circle_error_mm(double gain_1_s) {
  return circle_errors({.gain_1_s = gain_1_s}, kTaughtRadius_mm, kTaughtFeed_mm_s)
      .value()
      .contour_error_mm;
}

TEST(LearnFrom, FindsWhatTheMachineFileDoesNotKnow) {
  const LearntFrom taught = taught_by({40.0});
  ASSERT_EQ(taught.figures.size(), 1U);
  const LearningFigures& figures = taught.figures[0];
  const double unknown_mm = circle_error_mm(40.0) - circle_error_mm(50.0);
  EXPECT_NEAR(figures.measured_rms_mm, circle_error_mm(40.0), 0.03 * circle_error_mm(40.0));
  EXPECT_NEAR(figures.unknown_rms_mm, unknown_mm, 0.05 * unknown_mm);
  // Only where the record's first 2 mm prove that it is on the path.
  ASSERT_EQ(figures.left_out.size(), 1U);
  EXPECT_LT(figures.left_out[0].to_s, 0.1);
  EXPECT_GT(figures.learns_s, 0.95 * figures.cut_s);
  EXPECT_LT(figures.convergence, 1.0);
}

// Half a turn on, the tool is at (−10, 0) and misses outwards, to −X. The command leads by a 50th
// of a second more of that error, which turns with the tool: towards −Y.
TEST(LearnFrom, DisplacesTheCommandOutwardsAndAhead) {
  const Learnt learnt = taught_by({40.0}).learnt;
  const double unknown_mm = circle_error_mm(40.0) - circle_error_mm(50.0);
  const double half_turns_mm =
      10.0 + 3.0 * std::numbers::pi * kTaughtRadius_mm;  // behind the rapid
  const auto off = learnt.unknown_mm(half_turns_mm);
  EXPECT_NEAR(off[0], -unknown_mm, 0.03 * unknown_mm);
  EXPECT_NEAR(off[1], 0.0, 0.03 * unknown_mm);
  const auto shift = learnt.shift_mm(half_turns_mm);
  EXPECT_NEAR(shift[0], -unknown_mm, 0.03 * unknown_mm);
  EXPECT_NEAR(shift[1], -unknown_mm * kTaughtFeed_mm_s / kTaughtRadius_mm / 50.0,
              0.03 * unknown_mm);
}

TEST(LearnFrom, OfSeveralPartsTheMeanCounts) {
  const double place_mm = 70.0;
  const auto norm_at = [&](const std::vector<double>& gains_1_s) {
    return math::geometry::norm(taught_by(gains_1_s).learnt.unknown_mm(place_mm));
  };
  EXPECT_NEAR(norm_at({40.0, 45.0}), 0.5 * (norm_at({40.0}) + norm_at({45.0})), 1e-6);
  EXPECT_EQ(taught_by({40.0, 45.0, 50.0}).figures.size(), 3U);
}

TEST(LearnFrom, AMachineThatIsAsItsFileSaysTeachesNothing) {
  const LearntFrom taught = taught_by({50.0});
  EXPECT_LT(taught.figures[0].unknown_rms_mm, 2e-4);
  EXPECT_NEAR(taught.figures[0].measured_rms_mm, circle_error_mm(50.0), 1e-3);
  EXPECT_TRUE(taught_by({}).learnt.empty());
}

}  // namespace
}  // namespace steadyrest::contour::offline
