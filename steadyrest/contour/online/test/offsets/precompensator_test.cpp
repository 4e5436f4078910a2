// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/precompensator.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::OffsetRequest;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;
using test::Point;

constexpr double kFrame_s = 0.001;
constexpr double kGain_1_s = 50.0;

Precompensator::Config allowing(double max_offset_mm, double backlash_mm = 0.0) {
  Precompensator::Config config{.axes = test::mill().axes, .max_offset_mm = max_offset_mm};
  for (kernel::machine::Axis& axis : config.axes) {
    axis.backlash_au = backlash_mm;
  }
  return config;
}

/// A machine whose command runs along a path, with the offsets allowed.
class Travel {
 public:
  explicit Travel(std::vector<PathSegment> path,
                  const Precompensator::Config& config = allowing(0.5))
      : offsets(Precompensator::make(config).value()),
        path_(std::move(path)),
        ahead_(test::mill().axes, kernel::machine::kUnlimited, 3.0) {
    for (int i = 0; i < 60; ++i) {
      ahead_.update(path_, 0, 0.0, 0.0, 200.0);
    }
    const AxisModel model{kGain_1_s, 0.0, 0.0};
    offsets.set_model(std::array{model, model, model});
  }
  /// One cycle, at whose end the command has this speed.
  OffsetRequest cycle(double speed_mm_s) {
    frame.path_position_mm += 0.5 * (frame.path_speed_mm_s + speed_mm_s) * kFrame_s;
    frame.path_speed_mm_s = speed_mm_s;
    return again();
  }
  OffsetRequest again() {
    return offsets.update({.frame = frame,
                           .path = ahead_,
                           .step_s = step_s,
                           .active = active,
                           .permitted = permitted});
  }
  OffsetRequest cycles(double speed_mm_s, int count) {
    OffsetRequest request;
    for (int i = 0; i < count; ++i) {
      request = cycle(speed_mm_s);
    }
    return request;
  }
  [[nodiscard]] Point command() const {
    const Cell& cell = ahead_.cell(ahead_.find(frame.path_position_mm, ahead_.begin()));
    return on_cell(cell, frame.path_position_mm - cell.position_mm);
  }

  Precompensator offsets;
  kernel::signal::Frame frame;
  double step_s = kFrame_s;
  bool active = true;
  bool permitted = true;

 private:
  std::vector<PathSegment> path_;
  LookAhead ahead_;
};

std::vector<PathSegment> circle_of(double radius_mm) {
  return PathMaker({radius_mm, 0, 0}, 50.0).arc({0, 0, 0}, kTurn).path();
}

double size(const OffsetRequest& request) {
  return std::hypot(request.offset_mm[0], request.offset_mm[1]);
}

// In complex numbers, with x = ω/k: the tool is at y, the command at y·e^jx, and the axes need y·(1
// + jx) to be there. So the offset is y·(1 + jx − e^jx), about ½x²R towards the outside.
TEST(Precompensator, OnACircleAsksForTheInverseOfTheServo) {
  constexpr double kRadius_mm = 10.0;
  constexpr double kSpeed_mm_s = 40.0;
  Travel run(circle_of(kRadius_mm));
  const OffsetRequest request = run.cycles(kSpeed_mm_s, 1000);
  EXPECT_EQ(request.reason, Reason::contour_cancelled);
  EXPECT_EQ(request.room, kernel::signal::Room::contour);
  const double x = kSpeed_mm_s / kRadius_mm / kGain_1_s;
  // The offset acts with the next command.
  const double command_rad = (run.frame.path_position_mm + kSpeed_mm_s * kFrame_s) / kRadius_mm;
  const std::complex<double> tool = std::polar(kRadius_mm, command_rad - x);
  const std::complex<double> offset = tool * (std::complex<double>(1.0, x) - std::polar(1.0, x));
  EXPECT_NEAR(request.offset_mm[0], offset.real(), 1e-4);
  EXPECT_NEAR(request.offset_mm[1], offset.imag(), 1e-4);
  EXPECT_NEAR(size(request), 0.5 * x * x * kRadius_mm, 0.001);  // 32 µm: no small thing
  EXPECT_GT(size(request), 0.03);
}

/// The largest difference between what was asked for and what the present command needs.
double missed_mm(const Travel& run, const OffsetRequest& asked) {
  const Point command = run.command();
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double needed_mm = run.offsets.state().tool.command_mm[i] - command[i];
    worst_mm = std::max(worst_mm, std::abs(asked.offset_mm[i] - needed_mm));
  }
  return worst_mm;
}

// What was asked for with one frame is what the next frame's command needed.
TEST(Precompensator, PredictsTheCommandByOneCycle) {
  Travel run(circle_of(10.0));
  const OffsetRequest asked = run.cycles(40.0, 800);
  run.cycle(40.0);
  EXPECT_LT(missed_mm(run, asked), 1e-9);
}

// At 1000 mm/s² the speed changes by 1 mm/s in a cycle; half of it is the next mean's.
TEST(Precompensator, PredictsASteadyAccelerationExactly) {
  Travel run(circle_of(10.0));
  run.cycle(0.0);
  OffsetRequest asked = run.cycle(1.0);
  for (double speed_mm_s = 2.0; speed_mm_s <= 40.0; speed_mm_s += 1.0) {
    const OffsetRequest next = run.cycle(speed_mm_s);
    EXPECT_LT(missed_mm(run, asked), 1e-9) << speed_mm_s;
    asked = next;
  }
}

// The share grows by step/fade: 0.5 % a cycle at 1 ms and 0.2 s.
TEST(Precompensator, FadesInOnAMovingMachine) {
  Travel run(circle_of(10.0));
  run.active = false;
  run.cycles(40.0, 500);
  EXPECT_EQ(run.offsets.state().share, 0.0);
  run.active = true;
  const OffsetRequest half = run.cycles(40.0, 100);
  EXPECT_NEAR(run.offsets.state().share, 0.5, 1e-9);
  EXPECT_EQ(half.reason, Reason::contour_cancel_begins);
  EXPECT_FALSE(run.offsets.in_full().has_value());
  const OffsetRequest full = run.cycles(40.0, 101);
  EXPECT_EQ(full.reason, Reason::contour_cancelled);
  EXPECT_NEAR(size(half) / size(full), 0.5, 0.01);
  ASSERT_TRUE(run.offsets.in_full().has_value());
  EXPECT_EQ(run.offsets.in_full()->position_mm, run.offsets.position_mm());
}

TEST(Precompensator, BeginsInFullAtRest) {
  Travel run(circle_of(10.0));
  EXPECT_EQ(run.cycle(0.0).reason, Reason::contour_cancelled);
  EXPECT_EQ(run.offsets.state().share, 1.0);
}

// Half of the backlash on each side, once it is known in which direction the axis goes.
TEST(Precompensator, TakesHalfOfTheBacklashOut) {
  Travel run(PathMaker({0, 0, 0}, 50.0).line_to({100, 0, 0}).path(), allowing(0.5, 0.02));
  const OffsetRequest request = run.cycles(20.0, 500);
  EXPECT_NEAR(request.offset_mm[0], 0.01, 1e-9);
  EXPECT_EQ(request.offset_mm[2], 0.0);
}

TEST(Precompensator, AsksForNothingWhereTheMachineAllowsNothing) {
  Travel run(circle_of(10.0), allowing(0.0));
  EXPECT_FALSE(run.offsets.enabled());
  const OffsetRequest request = run.cycles(40.0, 300);
  EXPECT_EQ(size(request), 0.0);
  EXPECT_EQ(request.reason, Reason::none);
  EXPECT_FALSE(run.offsets.started());
}

// Whatever ends the wish, nothing of it is left, and it begins again from the smallest share.
TEST(Precompensator, WithdrawsAndBeginsAgain) {
  const auto expect_withdrawn = [](Travel& run, const char* why) {
    const OffsetRequest request = run.again();
    EXPECT_EQ(size(request), 0.0) << why;
    EXPECT_EQ(request.reason, Reason::none) << why;
    EXPECT_FALSE(run.offsets.started()) << why;
  };
  Travel thread(circle_of(10.0));
  thread.cycles(40.0, 400);
  thread.permitted = false;
  expect_withdrawn(thread, "a thread is cut");
  thread.permitted = true;
  thread.cycles(40.0, 2);
  EXPECT_LT(thread.offsets.state().share, 0.011);

  Travel lost(circle_of(10.0));
  lost.cycles(40.0, 400);
  lost.frame.path_position_mm = 1e6;
  expect_withdrawn(lost, "the command is beyond what is known of the path");

  Travel back(circle_of(10.0));
  back.cycles(40.0, 400);
  back.frame.path_position_mm -= 5.0;
  back.again();
  EXPECT_EQ(back.offsets.state().share, kFrame_s / 0.2) << "another place: it fades in again";
}

TEST(Precompensator, HasNoWishWhileTheCycleIsUnknown) {
  Travel run(circle_of(10.0));
  run.cycles(40.0, 400);
  run.step_s = 0.0;
  EXPECT_EQ(size(run.cycle(40.0)), 0.0);
}

TEST(Precompensator, GoesOnFromARestoredState) {
  Travel one(circle_of(10.0));
  Travel two(circle_of(10.0));
  one.cycles(40.0, 137);
  two.frame = one.frame;
  two.offsets.restore(one.offsets.state());
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(one.cycle(35.0).offset_mm, two.cycle(35.0).offset_mm) << i;
  }
  one.offsets.reset();
  EXPECT_FALSE(one.offsets.started());
}

TEST(Precompensator, AllocatesNothingInTheCycle) {
  Travel run(circle_of(10.0));
  run.cycle(0.0);
  const kernel::rt::testing::AllocationGuard guard;
  run.cycles(40.0, 500);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Precompensator, RefusesWhatIsNoLimit) {
  for (const double bad : {-0.001, kernel::units::kNan, kernel::units::kInfinity}) {
    EXPECT_FALSE(Precompensator::make(allowing(bad))) << bad;
  }
  for (const double bad : {0.0, -1.0, kernel::units::kNan}) {
    Precompensator::Config config = allowing(0.1);
    config.fade_in_s = bad;
    EXPECT_FALSE(Precompensator::make(config)) << bad;
  }
  EXPECT_TRUE(Precompensator::make(allowing(0.0)));
}

}  // namespace
}  // namespace steadyrest::contour::online
