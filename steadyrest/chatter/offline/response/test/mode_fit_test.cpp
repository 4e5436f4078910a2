// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/mode_fit.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::testing::cases;
using Complex = std::complex<double>;

enum class Noise { proportional, even };

/// 100 … 2000 Hz in steps of 1 Hz; `noise` relative to each value, or to a tenth of the largest
/// everywhere.
Frf measured(const std::vector<FittedMode>& modes, double noise, Noise kind, unsigned seed) {
  Frf out;
  double largest = 0.0;
  for (int f = 100; f <= 2000; ++f) {
    const double w = 2.0 * std::numbers::pi * f;
    Complex h = 2e-5;  // modes above the band
    for (const FittedMode& m : modes) {
      const double w0 = 2.0 * std::numbers::pi * m.frequency_hz;
      h += 1000.0 / m.mass_kg / Complex(w0 * w0 - w * w, 2.0 * m.damping_ratio * w0 * w);
    }
    out.frequency_hz.push_back(f);
    out.compliance_mm_n.push_back(h);
    largest = std::max(largest, std::abs(h));
  }
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, std::sqrt(0.5));
  for (Complex& h : out.compliance_mm_n) {
    // An accelerometer's noise floor is even; gain errors of hammer and sensor scale with the
    // response.
    const double size = kind == Noise::even ? 0.1 * largest : std::abs(h);
    const double re = normal(generator);
    h += noise * size * Complex(re, normal(generator));
  }
  return out;
}

void expect_found(const std::vector<FittedMode>& modes, double noise, Noise kind, unsigned seed) {
  const Frf frf = measured(modes, noise, kind, seed);
  const auto fit = fit_modes(std::span(&frf, 1), {});
  ASSERT_TRUE(fit) << kernel::outcome::text(fit.error());
  ASSERT_EQ(fit->modes.size(), modes.size()) << "noise " << noise << ", seed " << seed;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    EXPECT_NEAR(fit->modes[k].frequency_hz / modes[k].frequency_hz, 1.0, 1e-3);
    EXPECT_NEAR(fit->modes[k].damping_ratio / modes[k].damping_ratio, 1.0, 0.05);
    EXPECT_NEAR(fit->modes[k].mass_kg / modes[k].mass_kg, 1.0, 0.05);
    const double w = 2.0 * std::numbers::pi * fit->modes[k].frequency_hz;
    EXPECT_NEAR(fit->modes[k].stiffness_n_mm * 1e3, fit->modes[k].mass_kg * w * w, 1e-3);
  }
  if (kind == Noise::proportional) {
    // From both sides: a residual below half the noise means that noise was fitted.
    EXPECT_GT(fit->residual, 0.5 * noise);
    EXPECT_LT(fit->residual, 1.5 * noise);
  }
}

TEST(ModeFit, FindsOneTwoAndThreeModesUnderNoise) {
  const std::vector<std::vector<FittedMode>> machines = {
      {{922.0, 0.011, 0.03993, 0.0}},
      {{600.0, 0.03, 0.4, 0.0}, {660.0, 0.03, 0.35, 0.0}},
      {{450.0, 0.02, 1.2, 0.0}, {900.0, 0.01, 0.5, 0.0}, {1450.0, 0.03, 0.3, 0.0}}};
  for (const auto& modes : machines) {
    for (const double noise : cases({0.01, 0.05})) {
      for (const Noise kind : cases({Noise::proportional, Noise::even})) {
        for (const unsigned seed : cases({1U, 2U})) {
          expect_found(modes, noise, kind, seed);
        }
      }
    }
  }
}

/// 12 Hz apart, half-power bands of 20 Hz: at 5 % noise their masses are known only to 13 %.
TEST(ModeFit, TellsCloseModesApart) {
  for (const unsigned seed : cases({1U, 2U, 3U, 4U})) {
    expect_found({{500.0, 0.02, 1.0, 0.0}, {512.0, 0.02, 1.5, 0.0}}, 0.01, Noise::proportional,
                 seed);
  }
}

TEST(ModeFit, TakesSeveralMeasurementsTogether) {
  const std::vector<FittedMode> mode = {{922.0, 0.011, 0.03993, 0.0}};
  const std::vector<Frf> twice = {measured(mode, 0.05, Noise::proportional, 1),
                                  measured(mode, 0.05, Noise::proportional, 2)};
  const auto fit = fit_modes(twice, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 2U * 1901U);
  EXPECT_NEAR(fit->modes.at(0).frequency_hz, 922.0, 0.2);
}

TEST(ModeFit, TakesTheOrderThatIsAskedForAndTheBand) {
  const Frf frf =
      measured({{600.0, 0.03, 0.4, 0.0}, {1400.0, 0.03, 0.35, 0.0}}, 0.01, Noise::proportional, 1);
  const auto fit = fit_modes(std::span(&frf, 1), {.order = 1, .least_frequency_hz = 1000.0});
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->modes.size(), 1U);
  EXPECT_NEAR(fit->modes[0].frequency_hz, 1400.0, 5.0);
}

TEST(ModeFit, ItsResponseLeavesWhatItSaysThatItLeaves) {
  const Frf frf =
      measured({{300.0, 0.03, 2.0, 0.0}, {922.0, 0.011, 0.04, 0.0}}, 0.03, Noise::proportional, 7);
  const auto fit = fit_modes(std::span(&frf, 1), {});
  ASSERT_TRUE(fit) << kernel::outcome::text(fit.error());
  double left = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < frf.frequency_hz.size(); ++i) {
    const Complex h = frf.compliance_mm_n[i];
    left += std::norm(h - response_mm_n(*fit, frf.frequency_hz[i]));
    all += std::norm(h);
  }
  EXPECT_NEAR(std::sqrt(left / all), fit->residual, 1e-9);
}

/// Only noise, `even` or falling with 1/ω², as an accelerometer's does in displacement.
Frf noise_of(std::size_t points, bool even, unsigned seed) {
  Frf out;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < points; ++i) {
    const double f = 100.0 + 1900.0 * static_cast<double>(i) / static_cast<double>(points);
    const double size = even ? 1e-5 : 1.0 / (f * f);
    const double re = size * normal(generator);
    out.frequency_hz.push_back(f);
    out.compliance_mm_n.emplace_back(re, size * normal(generator));
  }
  return out;
}

TEST(ModeFit, FindsNoModeInNoise) {
  for (const std::size_t points : cases({8U, 12U, 50U, 200U})) {
    for (const bool even : cases({true, false})) {
      for (unsigned seed = 1; seed <= 8; ++seed) {
        const Frf frf = noise_of(points, even, seed);
        for (const std::size_t order : cases({0U, 2U})) {
          EXPECT_FALSE(fit_modes(std::span(&frf, 1), {.order = order}))
              << points << " points, even " << even << ", seed " << seed;
        }
      }
    }
  }
}

/// The other side of the bound: a mode that holds little of the energy of the noise around it,
/// and eight clean points.
TEST(ModeFit, FindsAModeThatIsLittleMoreThanNoise) {
  const std::vector<FittedMode> mode = {{922.0, 0.011, 0.03993, 0.0}};
  const Frf faint = measured(mode, 3.0, Noise::even, 1);
  const auto fit = fit_modes(std::span(&faint, 1), {});
  ASSERT_TRUE(fit) << kernel::outcome::text(fit.error());
  EXPECT_GT(fit->residual, 0.9);
  EXPECT_NEAR(fit->modes[0].frequency_hz, 922.0, 5.0);

  Frf few;
  const Frf clean = measured(mode, 0.01, Noise::proportional, 1);
  for (std::size_t i = 742; i < 902; i += 20) {
    few.frequency_hz.push_back(clean.frequency_hz[i]);
    few.compliance_mm_n.push_back(clean.compliance_mm_n[i]);
  }
  EXPECT_TRUE(fit_modes(std::span(&few, 1), {}));
}

TEST(ModeFit, RefusesAMeasurementGivenTwice) {
  std::vector<Frf> twice(2, measured({{922.0, 0.011, 0.03993, 0.0}}, 0.01, Noise::even, 1));
  twice[0].file = "tap.csv";
  twice[1].file = "copy.csv";
  const auto fit = fit_modes(twice, {});
  ASSERT_FALSE(fit);
  EXPECT_EQ(kernel::outcome::text(fit.error()),
            "copy.csv: the same response as in tap.csv; give each measurement once");
}

TEST(ModeFit, RefusesWhatNoModeExplains) {
  Frf frf = measured({{922.0, 0.011, 0.03993, 0.0}}, 0.01, Noise::proportional, 1);
  EXPECT_FALSE(fit_modes({}, {}));
  EXPECT_FALSE(fit_modes(std::span(&frf, 1), {.least_frequency_hz = 1995.0}));
  EXPECT_FALSE(fit_modes(std::span(&frf, 1), {.most_modes = 17}));
  for (Complex& h : frf.compliance_mm_n) {
    h = -h;
  }
  const auto fit = fit_modes(std::span(&frf, 1), {});
  if (fit) {
    EXPECT_GT(fit->residual, 0.3);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline
