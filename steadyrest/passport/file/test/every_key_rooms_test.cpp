// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/file/test/full_machine.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// Every key of full_machine.hpp must reach its field of the machine.
namespace steadyrest::passport {
namespace {

using kernel::machine::CompensationMethod;
using kernel::machine::Machine;
using kernel::machine::SpeedLaw;
using test::full;

TEST(EveryKey, Program) {
  const auto program = full().program;
  EXPECT_EQ(program.startup, "G20 G64 P0.001");
  EXPECT_EQ(program.remapped, "M6 G88.8 T");
  EXPECT_EQ(program.wrapped_axes, "A");
  EXPECT_EQ(program.indexer_axes, "BC");
  EXPECT_TRUE(program.tool_change_quill_up);
  EXPECT_TRUE(program.tool_change_at_g30);
  EXPECT_TRUE(program.tool_change_with_spindle_on);
  EXPECT_EQ(program.tool_change_position_mm, (std::vector{1.25, -2.5, 31.0}));
  ASSERT_EQ(program.tool_change_rotary_rad.size(), 3U);
  EXPECT_DOUBLE_EQ(program.tool_change_rotary_rad[0], 0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(program.tool_change_rotary_rad[2], -std::numbers::pi);
  EXPECT_TRUE(program.tool_change_keeps_offset);
  EXPECT_FALSE(program.fanuc_subprograms);
  EXPECT_FALSE(program.g92_persists);
  EXPECT_DOUBLE_EQ(program.arc_tolerance_mm, 0.011);
  EXPECT_DOUBLE_EQ(program.inch_arc_tolerance_mm, 0.012);
  EXPECT_EQ(program.subprogram_folders, "subs:/macros");
}

TEST(EveryKey, Chatter) {
  const auto chatter = full().chatter;
  EXPECT_TRUE(chatter.enabled);
  EXPECT_EQ(chatter.law, SpeedLaw::random);
  EXPECT_DOUBLE_EQ(chatter.amplitude_rev_s, 3);
  EXPECT_DOUBLE_EQ(chatter.period_s, 0.57);
  EXPECT_DOUBLE_EQ(chatter.mean_ratio, 0.58);
  EXPECT_DOUBLE_EQ(chatter.min_feed_per_tooth_ratio, 0.59);
  EXPECT_DOUBLE_EQ(chatter.max_feed_per_tooth_ratio, 1.6);
  EXPECT_EQ(chatter.m_code_on, 138U);
  EXPECT_EQ(chatter.m_code_off, 139U);
  EXPECT_EQ(chatter.seed, 73U);
  // amplitude_rpm and amplitude_percent exclude each other; a separate text tests the second.
  std::string text(test::kFullMachine);
  text.replace(text.find("amplitude_rpm = 180"), 19, "amplitude_percent = 18");
  const auto percent = parse(text, "percent.toml");
  ASSERT_TRUE(percent);
  EXPECT_DOUBLE_EQ(percent->chatter.amplitude_ratio, 0.18);
}

// The keys belong to methods that exclude one another.
TEST(EveryKey, Compensation) {
  const auto with = [](std::string_view dialect, std::string_view section) {
    std::string text(test::kFullMachine);
    text.replace(text.find("dialect = \"linuxcnc\""), 20, dialect);
    const auto machine = parse(text + "\n[compensation]\n" + std::string(section), "full.toml");
    EXPECT_TRUE(machine) << section << kernel::outcome::text(machine.error());
    return machine.value_or(Machine{}).compensation;
  };
  using Method = CompensationMethod;
  EXPECT_EQ(full().compensation.method, Method::by_dialect);
  EXPECT_EQ(with("dialect = \"linuxcnc\"", "method = \"linuxcnc\"").method, Method::linuxcnc);
  const auto fanuc = with("dialect = \"fanuc\"", "method = \"fanuc\"\nexternal_offset_free = true");
  EXPECT_EQ(fanuc.method, Method::fanuc);
  EXPECT_TRUE(fanuc.external_offset_free);
  EXPECT_EQ(with("dialect = \"fanuc\"", "method = \"haas\"").method, Method::haas);
  constexpr std::string_view kSinumerik = "dialect = \"sinumerik\"";
  const auto parameter = with(kSinumerik, "method = \"r_parameter\"\nr_parameter = 0");
  EXPECT_EQ(parameter.method, Method::r_parameter);
  EXPECT_EQ(with(kSinumerik, "method = \"r_parameter\"\nr_parameter = 74").r_parameter, 74U);
  const auto data = with(kSinumerik, "method = \"setting_data\"\nsign = -1");
  EXPECT_EQ(data.method, Method::setting_data);
  EXPECT_EQ(data.sign, -1);
  EXPECT_FALSE(data.cleared_after_abort);
  EXPECT_TRUE(with(kSinumerik, "method = \"setting_data\"\nsign = 1\ncleared_after_abort = true")
                  .cleared_after_abort);
  EXPECT_EQ(with(kSinumerik, "method = \"frame_fine\"").method, Method::frame_fine);
  EXPECT_EQ(fanuc.least_increment_mm, 1e-3);
  EXPECT_EQ(with("dialect = \"fanuc\"", "least_increment_um = 0.1").least_increment_mm, 1e-4);
  // The methods exclude one another, so this count must be kept by hand.
  EXPECT_EQ(compensation_keys().size(), 6U) << "a key is not tried here";
}

}  // namespace
}  // namespace steadyrest::passport
