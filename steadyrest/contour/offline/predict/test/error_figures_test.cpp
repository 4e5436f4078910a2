// SPDX-License-Identifier: Apache-2.0
// The figures of a run, added up by hand.
#include <array>
#include <cstddef>
#include <span>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predict/error_figures.hpp>

namespace steadyrest::contour::offline {
namespace {

ModelSample figured(double error_mm, std::span<const OtherError> others = {}) {
  ModelSample sample;
  sample.error_mm = error_mm;
  sample.others = others;
  return sample;
}

// 3, 4 and 12 µm: RMS √(169/3) = 7.506 µm, two of three above 3.5 µm.
TEST(ErrorFigures, AreTheLargestTheRmsAndTheShareOverTheLimit) {
  ErrorFigures figures(0.0035);
  figures.add(figured(0.003), 1);
  figures.add(figured(-0.012), 2);
  figures.add(figured(0.004), 2);
  EXPECT_DOUBLE_EQ(figures.nominal().max_mm, 0.012);
  EXPECT_NEAR(figures.nominal().rms_mm(), 0.0075056, 1e-7);
  EXPECT_EQ(figures.nominal().samples, 3U);
  EXPECT_DOUBLE_EQ(figures.share_over(), 2.0 / 3.0);
}

TEST(ErrorFigures, AnErrorAtTheLimitKeepsIt) {
  ErrorFigures figures(0.01);
  figures.add(figured(0.01), 1);
  figures.add(figured(-0.01), 1);
  EXPECT_EQ(figures.share_over(), 0.0);
  figures.add(figured(-0.0101), 1);
  EXPECT_GT(figures.share_over(), 0.3);
}

TEST(ErrorFigures, TellTheLargestOfEachLineInAnyOrder) {
  ErrorFigures figures;
  figures.add(figured(0.002), 70);
  figures.add(figured(-0.009), 5);
  figures.add(figured(0.006), 5);
  figures.add(figured(0.004), 70);
  const auto& nominal = figures.nominal();
  EXPECT_NEAR(nominal.line_mm(5), 0.009, 1e-9);
  EXPECT_NEAR(nominal.line_mm(70), 0.004, 1e-9);
  for (const std::size_t without : {0U, 6U, 69U, 71U, 100'000U}) {
    EXPECT_EQ(nominal.line_mm(without), 0.0) << without;
  }
}

// Each of the other models has its figures.
TEST(ErrorFigures, KeepTheModelsApart) {
  ErrorFigures figures(0.01, 2);
  constexpr std::array<OtherError, 2> kOne = {{{0.001, 0.001}, {0.020, 0.021}}};
  constexpr std::array<OtherError, 2> kTwo = {{{0.007, 0.007}, {0.010, 0.010}}};
  figures.add(figured(0.002, kOne), 1);
  figures.add(figured(0.002, kTwo), 2);
  ASSERT_EQ(figures.others().size(), 2U);
  EXPECT_DOUBLE_EQ(figures.nominal().max_mm, 0.002);
  EXPECT_DOUBLE_EQ(figures.others()[0].max_mm, 0.007);
  EXPECT_DOUBLE_EQ(figures.others()[1].max_mm, 0.021);
  EXPECT_NEAR(figures.others()[0].rms_mm(), 0.005, 1e-12);  // √((1 + 49)/2)
  EXPECT_EQ(figures.others()[1].samples, 2U);
  EXPECT_EQ(figures.share_over(), 0.0) << "the others do not count";
}

TEST(ErrorFigures, OfNothingAreZero) {
  const ErrorFigures figures(0.01, 1);
  EXPECT_EQ(figures.nominal().rms_mm(), 0.0);
  EXPECT_EQ(figures.others()[0].rms_mm(), 0.0);
  EXPECT_EQ(figures.share_over(), 0.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
