// SPDX-License-Identifier: Apache-2.0
// Every unit of the files by its definition, derived here from mm, s, rad, rev/s, N and W only.
#include <numbers>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <steadyrest/passport/text/unit.hpp>

namespace steadyrest::passport {
namespace {

struct Defined {
  std::string_view key;
  std::string_view shown;
  double inner;  ///< of one of it
};

constexpr double kMinute_s = 60.0;
constexpr double kTurn_deg = 360.0;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

// Displacement per feed: a micrometre for each metre per minute, 10⁻³ mm over 1000 mm/60 s.
const Defined kDefined[] = {
    {"gain_1_s", "1/s", 1.0},
    {"gain_m_min_mm", "(m/min)/mm", 1000.0 / kMinute_s},
    {"feed_mm_min", "mm/min", 1.0 / kMinute_s},
    {"speed_mm_s", "mm/s", 1.0},
    {"acceleration_mm_s2", "mm/s²", 1.0},
    {"jerk_mm_s3", "mm/s³", 1.0},
    {"length_mm", "mm", 1.0},
    {"length_um", "µm", 1.0 / 1000.0},
    {"drift_um_min", "µm/min", 1.0 / 1000.0 / kMinute_s},
    {"drift_um_s", "µm/s", 1.0 / 1000.0},
    {"growth_um_k", "µm/K", 1.0 / 1000.0},
    {"growth_um_m_min", "µm/(m/min)", (1.0 / 1000.0) / (1000.0 / kMinute_s)},
    {"time_min", "min", kMinute_s},
    {"time_h", "h", 60.0 * kMinute_s},
    {"air_c", "°C", 1.0},
    {"rise_k", "K", 1.0},
    {"angle_deg", "°", kTurn_rad / kTurn_deg},
    {"speed_deg_s", "°/s", kTurn_rad / kTurn_deg},
    {"acceleration_deg_s2", "°/s²", kTurn_rad / kTurn_deg},
    {"jerk_deg_s3", "°/s³", kTurn_rad / kTurn_deg},
    {"time_s", "s", 1.0},
    {"time_ms", "ms", 1.0 / 1000.0},
    {"time_ns", "ns", 1.0 / 1e9},
    {"speed_rpm", "rev/min", 1.0 / kMinute_s},
    {"acceleration_rpm_s", "(rev/min)/s", 1.0 / kMinute_s},
    {"share_percent", "%", 1.0 / 100.0},
    {"rate_percent_s", "%/s", 1.0 / 100.0},
    {"power_kw", "kW", 1000.0},
    {"torque_n_m", "N·m", 1.0},
    {"inertia_kg_m2", "kg·m²", 1.0},
    {"frequency_hz", "Hz", 1.0},
    {"mass_kg", "kg", 1.0},
    {"stiffness_N_mm", "N/mm", 1.0},
    {"pressure_N_mm2", "N/mm²", 1.0},
    {"stiffness_N_um", "N/µm", 1000.0},
};

TEST(UnitDefinition, GivesTheInnerValueAndComesBack) {
  for (const Defined& defined : kDefined) {
    const Unit& unit = unit_of(defined.key);
    EXPECT_EQ(unit.shown, defined.shown) << defined.key;
    for (const double value : {1.0, -2.5, 1e6}) {
      const double inner = value * defined.inner;
      EXPECT_NEAR(unit.to_inner(value), inner, 1e-14 * std::abs(inner)) << defined.key;
      EXPECT_NEAR(unit.from_inner(inner), value, 1e-14 * std::abs(value)) << defined.key;
    }
    EXPECT_EQ(unit.to_inner(0.0), 0.0) << defined.key;
  }
}

// The stem is what is left in front of the whole unit, with its underscore.
TEST(UnitDefinition, LeavesTheKeysWord) {
  for (const Defined& defined : kDefined) {
    const auto word = defined.key.substr(0, defined.key.find('_'));
    EXPECT_EQ(stem_of(defined.key), word) << defined.key;
    EXPECT_EQ(unit_of(defined.key).suffix, defined.key.substr(word.size() + 1)) << defined.key;
  }
}

// A unit begins after an underscore: `mesh` is no time in hours, `track` no kelvin.
TEST(UnitDefinition, AnEndingInsideOfAWordIsNone) {
  for (const std::string_view word : {"mesh", "gains", "comm", "track", "cos", "_s", "s_"}) {
    EXPECT_EQ(unit_of(word).suffix, "") << word;
    EXPECT_EQ(stem_of(word), word);
  }
  EXPECT_EQ(unit_of("mm").shown, "mm") << "a key that is a unit and nothing else";
  EXPECT_EQ(stem_of("mm"), "");
}

}  // namespace
}  // namespace steadyrest::passport
