// SPDX-License-Identifier: Apache-2.0
// A changed program judged against its original. First with a tool that is exactly on the changed
// path, where geometry alone gives the error; then on the simulated machine.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::machine::Machine;
using nc::plan::PlannedPath;
using trial::test::kExamples;
using trial::test::machine_of;
using PathPointer = std::shared_ptr<const PlannedPath>;

/// Exact path mode: the control does not round the corners.
PathPointer plan(const std::string& blocks, const Machine& machine) {
  nc::plan::PathBuilder builder(machine);
  const auto report =
      nc::interpret::run_text("G17 G21 G90 G94 G61\nG1 F3000\n" + blocks + "M2\n", {}, builder)
          .value();
  EXPECT_TRUE(report.refused.empty()) << blocks;
  return std::make_shared<const PlannedPath>(builder.take().value());
}

PathPointer plan_file(const std::string& program, const Machine& machine) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  nc::plan::PathBuilder builder(machine);
  EXPECT_TRUE(nc::interpret::run_file(kExamples + "programs/" + program, config, builder));
  return std::make_shared<const PlannedPath>(builder.take().value());
}

std::shared_ptr<const Original> against(const PathPointer& changed, const PathPointer& original,
                                        double tube_mm = 1.0) {
  return std::make_shared<const Original>(Original::make(*changed, original, tube_mm).value());
}

struct Range {
  double least_mm = 1e9;
  double most_mm = -1e9;
};

/// The error's size while a tool without any lag is at `from_mm` … `to_mm` of the changed path;
/// less than 0: from the end.
Range size_on(const PathPointer& changed, const PathPointer& original, double from_mm,
              double to_mm) {
  const Machine machine = machine_of("ideal-k50.toml");
  auto error = TrueError::make(machine, against(changed, original)).value();
  const auto& path = changed->segments;
  const double end_mm = path.back().position_mm + path.back().length_mm;
  constexpr double kStep_mm = 0.05;
  Range out;
  kernel::signal::Frame frame;
  frame.path = path;
  frame.path_speed_mm_s = 50.0;
  for (double at_mm = 0.0; at_mm < end_mm; at_mm += kStep_mm) {
    frame.time_s = at_mm / frame.path_speed_mm_s;
    frame.path_position_mm = at_mm;
    frame.path_index = math::geometry::segment_at(path, at_mm);
    const auto& segment = path[frame.path_index];
    const auto point = math::geometry::point_at(
        segment, math::geometry::parameter_at(segment, at_mm - segment.position_mm));
    sim::Truth truth;
    std::ranges::copy(point, truth.program_mm.begin());
    std::ranges::copy(point, truth.tool_mm.begin());
    const auto measured = error.update(frame, truth);
    EXPECT_LT(std::abs(measured.own.error_mm), 1e-9) << "on its own path at " << at_mm;
    if (at_mm >= from_mm && at_mm <= (to_mm < 0.0 ? end_mm + to_mm : to_mm)) {
      const double size = std::abs(measured.original->error_mm);
      out = {std::min(out.least_mm, size), std::max(out.most_mm, size)};
    }
  }
  return out;
}

std::string circle(double radius_mm, int turns) {
  return fmt::format("G1 X{0} Y0\nG3 X{0} Y0 I-{0} J0 P{1}\n", radius_mm, turns);
}

TEST(AgainstTheOriginal, AWiderCircleIsWrongByWhatItIsWider) {
  const Machine machine = machine_of("ideal-k50.toml");
  for (const double wider_mm : {0.02, 0.088, 0.3}) {
    const Range size = size_on(plan(circle(10.0 + wider_mm, 3), machine),
                               plan(circle(10.0, 3), machine), 11.0, -1.0);
    EXPECT_NEAR(size.least_mm, wider_mm, 1e-9);
    EXPECT_NEAR(size.most_mm, wider_mm, 1e-9);
  }
}

// A shift across the plane is the error everywhere; one in the plane is its share across the line.
TEST(AgainstTheOriginal, AShiftedPathIsWrongByTheShareAcrossIt) {
  const Machine machine = machine_of("ideal-k50.toml");
  const auto square = [&](double dx, double dy, double dz) {
    return plan(fmt::format("G1 X{0} Y{1} Z{2}\nX{3}\nY{4}\nX{0}\nY{1}\n", 10 + dx, 10 + dy, 1 + dz,
                            40 + dx, 40 + dy),
                machine);
  };
  const double entry_mm = 14.5;
  const Range across = size_on(square(0, 0, 0.2), square(0, 0, 0), entry_mm, -0.5);
  EXPECT_NEAR(across.least_mm, 0.2, 1e-9);
  EXPECT_NEAR(across.most_mm, 0.2, 1e-9);
  // The first leg goes along X, from 14.18 to 44.18.
  const Range along = size_on(square(0.3, 0.1, 0), square(0, 0, 0), 16.0, 42.0);
  EXPECT_NEAR(along.least_mm, 0.1, 1e-9);
  EXPECT_NEAR(along.most_mm, 0.1, 1e-9);
}

/// The path of a square corner as the control rounds it within `tolerance_mm`, with what the
/// program writes.
PathPointer rounded_corner(double tolerance_mm, const Machine& machine) {
  const std::string text =
      fmt::format("G17 G21 G90 G94 G64 P{}\nG1 X20 F3000\nY20\nM2\n", tolerance_mm);
  auto path = nc::plan::plan_text(text, {}, machine, "corner").value();
  EXPECT_TRUE(path.tolerant);
  path.programmed = std::make_shared<const PlannedPath>(
      nc::plan::plan_programmed(machine, "corner", [&](nc::interpret::Sink& sink) {
        return nc::interpret::run_text(text, {}, sink);
      }).value());
  return std::make_shared<const PlannedPath>(std::move(path));
}

// The middle of the arc that rounds the corner is R(1 − 1/√2) from the legs.
TEST(AgainstTheOriginal, WhatTheControlRoundsALittleCounts) {
  const Machine machine = machine_of("ideal-k50.toml");
  for (const double tolerance_mm : {0.1, 0.3, 0.5}) {
    const PathPointer corner = rounded_corner(tolerance_mm, machine);
    const auto arc = std::ranges::find(corner->segments, kernel::signal::Geometry::arc,
                                       &kernel::signal::PathSegment::geometry);
    ASSERT_NE(arc, corner->segments.end());
    const double from_legs_mm = arc->radius_mm * (1.0 - std::sqrt(0.5));
    const Range size = size_on(corner, corner, 0.0, -0.1);
    EXPECT_NEAR(size.most_mm, from_legs_mm, 0.05 * from_legs_mm) << tolerance_mm;
  }
  const PathPointer wide = rounded_corner(0.6, machine);
  EXPECT_NEAR(size_on(wide, wide, 0.0, -0.1).most_mm, 0.0, 1e-9) << "a path of its own";
}

// On the fillet's middle the nearest leg is r(1 − 1/√2) away, while the corner is r(√2 − 1) from
// the fillet: what the fillet leaves standing there.
TEST(AgainstTheOriginal, AFilletInsideACornerIsWrongByItsDistanceFromTheLegs) {
  const Machine machine = machine_of("ideal-k50.toml");
  const double r = 1.5;
  const auto corner = plan("G1 X20 Y0\nY20\n", machine);
  const auto fillet =
      plan(fmt::format("G1 X{0} Y0\nG3 X20 Y{1} I0 J{1}\nG1 Y20\n", 20.0 - r, r), machine);
  const Range size = size_on(fillet, corner, 0.0, -0.1);
  EXPECT_EQ(size.least_mm, 0.0);
  EXPECT_NEAR(size.most_mm, r * (1.0 - std::sqrt(0.5)), 0.03);
  EXPECT_LE(size.most_mm, r * (1.0 - std::sqrt(0.5)) + 1e-9);
  // The other way round the corner is judged against the fillet: r(√2 − 1) at the corner.
  const Range corner_size = size_on(corner, fillet, 0.0, -0.1);
  EXPECT_NEAR(corner_size.most_mm, r * (std::sqrt(2.0) - 1.0), 0.05);
  EXPECT_LE(corner_size.most_mm, r * (std::sqrt(2.0) - 1.0) + 1e-9);
}

// Half a millimetre between the turns, a shift of 0.2 mm: the neighbouring turn is never taken. The
// spiral is cut out, back along itself, and out again.
TEST(AgainstTheOriginal, ASpiralThatComesBackIsNotTakenForItsNeighbour) {
  const Machine machine = machine_of("ideal-k50.toml");
  const auto pocket = [&](double z) {
    std::string blocks = fmt::format("G1 X1 Y0 Z{}\n", z);
    for (const bool back : {false, true, false}) {
      for (int i = 0; i < 12; ++i) {
        const int k = back ? 11 - i : i;
        const double from = 1.0 + 0.5 * (back ? k + 1 : k);
        const double to = 1.0 + 0.5 * (back ? k : k + 1);
        const bool half = (k % 2) == 0;
        const double end_x = back ? (half ? to : -to) : (half ? -to : to);
        const double start_x = back ? (half ? -from : from) : (half ? from : -from);
        blocks += fmt::format("{} X{:.3f} Y0 I{:.3f} J0\n", back ? "G2" : "G3", end_x,
                              0.5 * (end_x - start_x));
      }
    }
    return plan(blocks, machine);
  };
  const Range size = size_on(pocket(0.2), pocket(0.0), 1.5, -0.5);
  EXPECT_NEAR(size.least_mm, 0.2, 1e-9);
  EXPECT_NEAR(size.most_mm, 0.2, 1e-9);
}

/// The figures that must agree, with those that count.
void expect_same(const Figures& a, const Figures& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.samples_over_limit, b.samples_over_limit);
  EXPECT_EQ(a.cycle_time_s, b.cycle_time_s);
  EXPECT_NEAR(a.contour_error_max_mm, b.contour_error_max_mm, 1e-9);
  EXPECT_NEAR(a.contour_error_rms_mm, b.contour_error_rms_mm, 1e-9);
  EXPECT_EQ(a.tracking_error_max_mm, b.tracking_error_max_mm);
}

TEST(AgainstTheOriginal, AProgramAgainstItselfHasTheFiguresItHasAlone) {
  const Machine machine = machine_of("vmc-840d.toml");
  for (const std::string program : {"rib-pocket.mpf", "circle-r10.mpf"}) {
    const auto path = plan_file(program, machine);
    for (const bool with_layer : {false, true}) {
      Job job{.machine = machine, .path = path, .with_layer = with_layer};
      const Figures alone = run(job).value().figures();
      job.against = against(path, path);
      expect_same(run(job).value().figures(), alone);
      EXPECT_LT(job.against->farthest_mm, 1e-12);
    }
  }
}

// The reference circle, R = 10 mm at F4000 with k = 50 1/s, comes out 87.7 µm too small. Commanded
// larger by as much it is right to second order, where its own path is as wrong as before.
TEST(AgainstTheOriginal, ACircleCommandedLargerByItsErrorIsRight) {
  const Machine machine = machine_of("ideal-k50.toml");
  const auto original = plan("G1 X10 Y0 F4000\nG3 X10 Y0 I-10 J0 P5\n", machine);
  const auto changed = plan("G1 X10.0877 Y0 F4000\nG3 X10.0877 Y0 I-10.0877 J0 P5\n", machine);
  const auto largest = [&](const std::shared_ptr<const Original>& judge) {
    const double turn_mm = 20.0 * std::numbers::pi;
    double most_mm = 0.0;
    const auto look = [&](const Sample& sample) {
      if (sample.path_position_mm > 10.0 + turn_mm &&
          sample.path_position_mm < 10.0 + 4.0 * turn_mm) {
        most_mm = std::max(most_mm, std::abs(sample.contour_error_mm));
      }
    };
    EXPECT_TRUE(run({.machine = machine, .path = changed, .against = judge}, nullptr, look));
    return most_mm;
  };
  EXPECT_NEAR(largest(nullptr), 0.0877, 0.01 * 0.0877);
  EXPECT_LT(largest(against(changed, original)), 0.001);
}

// Where the changed program cuts on what the original passes in rapid, nothing counts.
TEST(AgainstTheOriginal, OnlyWhatBothCutCounts) {
  const Machine machine = machine_of("ideal-k50.toml");
  const auto original = plan("G1 X10\nG0 X40\nG1 X60\nY10\n", machine);
  const auto changed = plan("G1 X10\nG1 X40\nG1 X60\nY10\n", machine);
  const Figures both =
      run({.machine = machine, .path = changed, .against = against(changed, original)})
          .value()
          .figures();
  const Figures alone = run({.machine = machine, .path = changed}).value().figures();
  // 30 of 80 mm at 50 mm/s, in cycles of the control.
  const double left_out_s = alone.cutting_time_s - both.cutting_time_s;
  EXPECT_NEAR(left_out_s, 30.0 / 50.0, 0.02);
}

TEST(AgainstTheOriginal, ProgramsOfDifferentPartsAreRefusedWithBothLines) {
  const Machine machine = machine_of("ideal-k50.toml");
  const auto original = plan("G1 X10\nX20\nY20\nX0\n", machine);
  const auto changed = plan("G1 X10\nX20\nX30\nY20\nX0\n", machine);
  const auto refused = Original::make(*changed, original, 1.0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 5U) << "X30";
  EXPECT_THAT(refused.error().what, testing::HasSubstr("line 5 of the original"));
  const auto shorter = Original::make(*plan("G1 X10\nX20\n", machine), original, 1.0);
  ASSERT_FALSE(shorter);
  EXPECT_EQ(shorter.error().line, 4U);
  EXPECT_THAT(shorter.error().what, testing::HasSubstr("goes on in its line 5"));
  EXPECT_FALSE(Original::make(*original, original, 0.001));
  EXPECT_FALSE(Original::make(*original, original, 5.1));
}

}  // namespace
}  // namespace steadyrest::trial::cut
