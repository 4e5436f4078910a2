// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/thermal/online/test/turning.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using test::turning;

// The reference's one-mode curve for the paper's example: crossings of 10, 20, 30 and 40 µm.
ThermalAxis paper() {
  ThermalAxis axis;
  ThermalMode mode;
  mode.tau_s = 53.475 * 60.0;
  mode.speed_rev_s = {0.0, 10.0, 20.0};
  mode.level_mm = {0.0, 0.0352245, 0.0490785};
  axis.mode = {mode};
  return axis;
}

ThermalModel made(const ThermalAxis& axis) {
  auto model = ThermalModel::make(axis);
  EXPECT_TRUE(model);
  return std::move(*model);
}

// Times from the closed form t = −τ·ln((δ − G)/(x₀ − G)), worked out by hand for each stage.
TEST(ThermalModel, PassesThePapersCrossings) {
  ThermalModel model = made(paper());
  EXPECT_NEAR(model.update(17.857 * 60.0, turning(10.0)), 0.010, 1e-6);
  EXPECT_NEAR(model.update((44.857 - 17.857) * 60.0, turning(10.0)), 0.020, 1e-6);
  model.update((60.0 - 44.857) * 60.0, turning(10.0));
  EXPECT_NEAR(model.update(15.143 * 60.0, turning(20.0)), 0.030, 1e-6);
  EXPECT_NEAR(model.update((114.857 - 75.143) * 60.0, turning(20.0)), 0.040, 1e-6);
}

// 36 000 steps against one: Euler would be off by 1e-5 of the level, the exact step only by
// rounding.
TEST(ThermalModel, DoesNotDependOnTheSizeOfItsSteps) {
  ThermalModel whole = made(paper());
  ThermalModel parts = made(paper());
  const double once = whole.update(3600.0, turning(15.0));
  double last = 0.0;
  for (int i = 0; i < 3600 * 10; ++i) {
    last = parts.update(0.1, turning(15.0));
  }
  EXPECT_NEAR(last, once, 1e-14);
}

// After one rest time constant 1/e remains.
TEST(ThermalModel, HasItsOwnTimeConstantAtRest) {
  ThermalAxis axis = paper();
  axis.mode[0].rest_tau_s = 100.0;
  ThermalModel model = made(axis);
  const double warm = model.update(1e6, turning(20.0));
  EXPECT_NEAR(warm, 0.0490785, 1e-12);
  EXPECT_NEAR(model.update(100.0, turning(0.0)), warm / std::exp(1.0), 1e-12);
}

TEST(ThermalModel, LevelsComeFromTableOrPolynomialAndKnowLoadCoolantAndFeed) {
  ThermalAxis axis = paper();
  axis.mode[0].cutting_ratio = 1.5;
  axis.mode[0].coolant_ratio = 0.5;
  axis.mode[0].feed_s = 0.001;
  const ThermalModel table = made(axis);
  EXPECT_NEAR(table.level_mm(0, turning(-15.0)), (0.0352245 + 0.0490785) / 2.0, 1e-12);
  EXPECT_NEAR(table.level_mm(0, turning(99.0)), 0.0490785, 1e-12);
  Drive drive = turning(10.0);
  drive.cutting = true;
  drive.feed_mm_s = 2.0;
  EXPECT_NEAR(table.level_mm(0, drive), 1.5 * 0.0352245 + 0.002, 1e-12);
  drive.coolant = true;
  EXPECT_NEAR(table.level_mm(0, drive), 0.75 * 0.0352245 + 0.002, 1e-12);
  ThermalAxis other;
  other.mode.emplace_back();
  other.mode[0].polynomial_mm = {0.002, -0.0005};
  // n = 3 in 1000 rpm: 0.002·3 − 0.0005·9.
  EXPECT_NEAR(made(other).level_mm(0, turning(50.0)), 0.006 - 0.0045, 1e-12) << "3000 rev/min";
}

// Inputs share exponentials and are summed four at a time; each alone has neither.
TEST(ThermalModel, ManyInputsAreEachWhatTheyAreAlone) {
  ThermalAxis all;
  std::vector<ThermalModel> alone;
  for (std::size_t j = 0; j < steadyrest::kernel::machine::kMaxThermalAmbients; ++j) {
    const auto at = static_cast<double>(j);
    ThermalAxis one;
    one.ambient.push_back({.sensor = "t",
                           .tau_s = 300.0 * static_cast<double>(j % 5),
                           .gain_mm_k = 0.001 * (at - 20.0),
                           .reference_c = 20.0 + 0.1 * at});
    all.ambient.push_back(one.ambient.front());
    alone.push_back(made(one));
  }
  ThermalModel model = made(all);
  for (int step = 0; step < 50; ++step) {
    Drive drive;
    double sum_mm = 0.0;
    for (std::size_t j = 0; j < alone.size(); ++j) {
      const auto at = static_cast<double>(j);
      const bool known = (static_cast<std::size_t>(step) + j) % 7 != 0;
      const double now = known ? 22.0 + std::sin(0.3 * at + 0.2 * step) : std::nan("");
      drive.ambient_c[j] = now;
      Drive own;
      own.ambient_c[0] = now;
      sum_mm += alone[j].update(90.0, own);
    }
    EXPECT_NEAR(model.update(90.0, drive), sum_mm, 1e-12);
  }
  ThermalModel again = made(all);
  again.restore(model.state());
  EXPECT_DOUBLE_EQ(again.displacement_mm(), model.displacement_mm());
}

TEST(ThermalModel, FollowsTheSurroundingsWithALag) {
  ThermalAxis axis;
  axis.ambient.push_back(
      {.sensor = "room", .tau_s = 600.0, .gain_mm_k = 0.003, .reference_c = 20.0, .state_c = 20.0});
  ThermalModel model = made(axis);
  Drive drive;
  drive.ambient_c[0] = 22.0;
  EXPECT_NEAR(model.update(0.0, drive), 0.006, 1e-12) << "the first reading is in equilibrium";
  drive.ambient_c[0] = 25.0;
  // From 22 towards 25 °C for one τ: 25 − 3/e, over the reference of 20.
  EXPECT_NEAR(model.update(600.0, drive), 0.003 * (5.0 - 3.0 / std::exp(1.0)), 1e-12);
}

TEST(ThermalModel, UnfitInputChangesNothing) {
  ThermalModel model = made(paper());
  const double before = model.update(600.0, turning(10.0));
  EXPECT_EQ(model.update(-1.0, turning(10.0)), before);
  EXPECT_EQ(model.update(std::numeric_limits<double>::quiet_NaN(), turning(10.0)), before);
  EXPECT_EQ(model.update(1.0, turning(std::numeric_limits<double>::infinity())), before);
  ThermalAxis axis;
  axis.ambient.push_back(
      {.sensor = "room", .tau_s = 600.0, .gain_mm_k = 0.003, .reference_c = 20.0, .state_c = 20.0});
  ThermalModel room = made(axis);
  Drive drive;
  drive.ambient_c[0] = 22.0;
  const double known = room.update(1.0, drive);
  drive.ambient_c[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(room.update(1000.0, drive), known) << "a lost sensor's last value is held";
}

// No time constant, a table whose columns differ in length, more modes than a model has room for.
TEST(ThermalModel, RefusesAPassportThatCannotBeUsed) {
  ThermalAxis axis = paper();
  axis.mode[0].tau_s = 0.0;
  EXPECT_FALSE(ThermalModel::make(axis));
  axis = paper();
  axis.mode[0].level_mm.pop_back();
  EXPECT_FALSE(ThermalModel::make(axis));
  axis = paper();
  axis.mode.resize(5, axis.mode[0]);
  EXPECT_FALSE(ThermalModel::make(axis));
}

TEST(ThermalModel, DoesNotAllocateInTheCycle) {
  ThermalModel model = made(paper());
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    model.update(0.001 * i, turning(0.3 * i));
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::online
