// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/text/unit.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::kUnlimited;

// max_feed_mm_min ends in min, mm_min and feed_mm_min; only the longest ending that is a unit is
// right. Gains end in m_min_mm, which ends in mm.
TEST(Unit, IsTheLongestEndingThatFits) {
  EXPECT_EQ(unit_of("servo_gain_m_min_mm").shown, "(m/min)/mm");
  EXPECT_EQ(unit_of("max_feed_mm_min").shown, "mm/min");
  EXPECT_EQ(unit_of("backlash_um").shown, "µm");
  EXPECT_EQ(unit_of("acceleration_rpm_s").shown, "(rev/min)/s");
  EXPECT_EQ(unit_of("percent").shown, "%");
  EXPECT_EQ(unit_of("feed_forward").shown, "");
}

// Foreign units count too: servo_gain_hz is a wrong unit, not an unknown key.
TEST(Unit, StemLeavesOutAnyUnitKnownOrForeign) {
  EXPECT_EQ(stem_of("servo_gain_m_min_mm"), "servo_gain");
  EXPECT_EQ(stem_of("servo_gain_hz"), "servo_gain");
  EXPECT_EQ(stem_of("backlash_in"), "backlash");
  EXPECT_EQ(stem_of("backlash"), "backlash");
}

// 3.7 is round in no unit, so a factor applied the wrong way round on the way back shows.
TEST(Unit, GoesThereAndBack) {
  for (const std::string_view key : {"gain_1_s", "gain_m_min_mm", "feed_mm_min", "a_um", "a_deg",
                                     "t_ms", "n_rpm", "p_percent", "p_kw", "j_kg_m2", "k_N_um"}) {
    const Unit& unit = unit_of(key);
    EXPECT_NEAR(unit.from_inner(unit.to_inner(3.7)), 3.7, 1e-12) << key;
  }
  EXPECT_NEAR(unit_of("gain_m_min_mm").to_inner(3.0), 50.0, 1e-12);
  EXPECT_NEAR(unit_of("n_rpm").to_inner(6000.0), 100.0, 1e-12);
  // 1.5 N/µm = 1500 N/mm.
  EXPECT_NEAR(unit_of("stiffness_N_um").to_inner(1.5), 1500.0, 1e-12);
}

/// Only ratios, weights and counts may go without a unit.
template <class S>
void expect_units(std::span<const Key<S>> keys) {
  const std::set<std::string_view> bare = {
      "feed_forward",   "weight_contour",           "weight_feed",      "centripetal_share",
      "blend_share",    "blend_gap_cycles",         "min_block_cycles", "merge_share",
      "junction_share", "corner_acceleration_share"};
  for (const Key<S>& key : keys) {
    if (std::holds_alternative<double S::*>(key.field)) {
      EXPECT_EQ(unit_of(key.name).suffix.empty(), bare.contains(key.name)) << key.name;
      EXPECT_LT(key.min, key.max) << key.name;
    }
  }
}

TEST(Schema, EveryDimensionalKeyEndsInItsUnit) {
  expect_units(top_keys());
  expect_units(control_keys());
  expect_units(axis_keys());
  expect_units(encoder_keys());
  expect_units(friction_keys());
  expect_units(override_keys());
  expect_units(spindle_keys());
  expect_units(contour_keys());
  expect_units(chatter_keys());
  expect_units(compensation_keys());
  expect_units(program_keys());
  expect_units(thermal_keys());
  expect_units(thermal_axis_keys());
  expect_units(thermal_mode_keys());
  expect_units(thermal_ambient_keys());
  expect_units(envelope_keys());
  expect_units(simulation_keys());
}

/// A default outside its own range could not be written into a file.
template <class S>
void expect_defaults_in_range(std::span<const Key<S>> keys) {
  const S standard{};
  for (const Key<S>& key : keys) {
    if (const auto* field = std::get_if<double S::*>(&key.field)) {
      const double value = unit_of(key.name).from_inner(standard.*(*field));
      const bool no_limit = value == kUnlimited;
      const bool absent = key.name == "binary_max_percent";
      EXPECT_TRUE(no_limit || absent || (value >= key.min && value <= key.max))
          << key.name << " = " << value;
    }
  }
}

TEST(Schema, EveryDefaultIsInItsRange) {
  expect_defaults_in_range(control_keys());
  expect_defaults_in_range(axis_keys());
  expect_defaults_in_range(friction_keys());
  expect_defaults_in_range(override_keys());
  expect_defaults_in_range(spindle_keys());
  expect_defaults_in_range(contour_keys());
  expect_defaults_in_range(chatter_keys());
  expect_defaults_in_range(envelope_keys());
  expect_defaults_in_range(thermal_keys());
  expect_defaults_in_range(thermal_axis_keys());
  expect_defaults_in_range(thermal_mode_keys());
  expect_defaults_in_range(thermal_ambient_keys());
  expect_defaults_in_range(simulation_keys());
}

}  // namespace
}  // namespace steadyrest::passport
