// SPDX-License-Identifier: Apache-2.0
// Machine files that do not give the lag of the velocity loops: whatever it is, the part must not
// come out worse. Judged by the axes of the simulated machine, which have it.
#include <array>
#include <cstddef>
#include <cstdlib>
#include <random>
#include <ranges>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/trial/cut/test/ahead/judged.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::machine::Machine;
using test::Judged;
using test::judged;

/// Axes without friction, backlash and noise.
Machine ideal_mill(double gain_1_s) {
  Machine machine = trial::test::machine_of("linuxcnc-mill.toml");
  for (auto& axis : machine.axes) {
    axis.servo_gain_1_s = gain_1_s;
    axis.backlash_au = 0.0;
    axis.friction = {};
    axis.encoder.count_au = 0.0;
  }
  return machine;
}

Machine with_unknown_lags(Machine machine) {
  for (auto& axis : machine.axes) {
    axis.velocity_lag_known = false;
  }
  return machine;
}

const std::string kHead = "G21 G90 G94 G17 ";

/// A tangent, three turns, a tangent.
std::string circle(double feed_mm_min) {
  return kHead + fmt::format("G64\nG0 X10 Y-20 Z0\nG4 P0.5\nG1 Y0 F{:.0f}\n", feed_mm_min) +
         "G3 X10 Y0 I-10 J0 P3\nG1 Y20\nM2\n";
}

// Truth: e = (1 − 2kτ)·v²/(2k²R). What the text takes off for kτ = 0 is all wrong at kτ = 0.5.
TEST(UnknownLag, TheCircleStaysAsItIs) {
  const kernel::file::testing::OwnFolder folder;
  const std::string file = folder.file("circle.ngc", circle(3000.0));
  const Machine believed = ideal_mill(30.0);
  Machine machine = believed;
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.5 / axis.servo_gain_1_s;
  }
  constexpr double kShrinks_mm = 50.0 * 50.0 / (2.0 * 30.0 * 30.0 * 10.0);
  const Judged trusting = judged(file, machine, believed, {.max_shift_mm = 2.0});
  EXPECT_NEAR(trusting.changed.contour_error_rms_mm, kShrinks_mm, 0.2 * kShrinks_mm);
  EXPECT_LT(trusting.original.contour_error_rms_mm, 0.2 * kShrinks_mm);
  const Judged careful = judged(file, machine, with_unknown_lags(believed), {.max_shift_mm = 2.0});
  EXPECT_EQ(careful.predicted.replaced.replaced, 0U);
  EXPECT_EQ(careful.predicted.unknown_lags, (std::vector<std::string>{"X", "Y"}));
  EXPECT_FALSE(careful.predicted.worse.empty());
}

class Parts {
 public:
  explicit Parts(std::uint64_t seed) : random_(seed) {}

  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Corners and an arc, a pocket with fillets, or a helix.
  std::string next(int kind) {
    const double feed = within(600.0, 3000.0);
    const double radius = within(1.5, 8.0);
    const std::string head =
        kHead + (within(0.0, 1.0) < 0.5 ? "G61" : "G64 P0.02") + "\nG0 X0 Y0 Z0\nG4 P0.3\n";
    if (kind == 0) {
      return head + fmt::format(
                        "G1 X{0:.2f} Y{1:.2f} F{2:.0f}\nX{3:.2f} Y{4:.2f}\n"
                        "G3 X{5:.2f} Y{4:.2f} I{6:.2f} J0\nG1 Y0\nM2\n",
                        within(8, 15), within(-6, 6), feed, 20.0, 12.0, 20.0 - 2.0 * radius,
                        -radius);
    }
    if (kind == 1) {
      return head + fmt::format(
                        "G1 X{0:.2f} F{1:.0f}\nG3 X{2:.2f} Y{3:.2f} J{3:.2f} I0\n"
                        "G1 Y20\nG2 X{4:.2f} Y{5:.2f} I{3:.2f} J0\nG1 X40\nM2\n",
                        10.0, feed, 10.0 + radius, radius, 10.0 + 2.0 * radius, 20.0 + radius);
    }
    return head + fmt::format("G1 X10 F{:.0f}\nG3 X10 Y0 I{:.2f} J0 Z-1 P2\nG1 Y{:.2f}\nM2\n", feed,
                              -radius, within(3, 10));
  }

 private:
  std::mt19937_64 random_;
};

/// STEADYREST_MACHINES: how many.
int part_count() {
  const char* const text = std::getenv("STEADYREST_MACHINES");
  return text == nullptr ? 12 : std::atoi(text);
}

// Each axis has its own lag and a gain within the 5 % that the text allows for.
TEST(UnknownLag, MakesNoPartWorse) {
  constexpr double kMore_mm = 0.001;
  constexpr double kGrows = 1.005;  // the largest error, at most
  const kernel::file::testing::OwnFolder folder;
  Parts parts(20261129);
  for (const int i : kernel::testing::cases(std::views::iota(0, part_count()), 3)) {
    const Machine believed = ideal_mill(parts.within(15.0, 60.0));
    Machine machine = believed;
    for (auto& axis : machine.axes) {
      axis.velocity_lag_s = parts.within(0.0, 0.5) / axis.servo_gain_1_s;
      axis.servo_gain_1_s *= parts.within(0.95, 1.05);
    }
    const std::string file = folder.file("part.ngc", parts.next(i % 3));
    const Judged part = judged(file, machine, with_unknown_lags(believed), {.max_shift_mm = 2.0});
    EXPECT_LE(part.changed.contour_error_rms_mm, part.original.contour_error_rms_mm + kMore_mm)
        << i;
    EXPECT_LE(part.changed.contour_error_max_mm,
              kGrows * part.original.contour_error_max_mm + kMore_mm)
        << i;
  }
}

}  // namespace
}  // namespace steadyrest::trial::cut
