// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/edit/servo_edit.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::passport {
namespace {

using testing::HasSubstr;

const std::string kLimits = "max_feed_mm_min = 12000\nmax_acceleration_mm_s2 = 2000 # größer µm\n";
const std::string kServoX =
    "# µ\n[[axis]]\nname = \"X\"\n  servo_gain_m_min_mm = 3   # = 50 1/s\n" + kLimits +
    "feed_forward = 0.1\n";
const std::string kServoY =
    "[[axis]]\nname = \"Y\"\nservo_gain_1_s = 20 # ASSUMED: measure\n" + kLimits;
const std::string kRest =
    "[control]\ndialect = \"linuxcnc\"\n[override.feed]\npercent = [0, 50, 100]";

std::vector<ServoValues> both() {
  return {{"X", 40.0, 0.25, "fitted: sd 0.1", "fitted: sd 0.01"},
          {"Y", 33.3333, 0.5, "fitted\nx", ""}};
}

TEST(ServoEdit, ReplacesValuesWithTheirCommentsAndNothingElse) {
  const auto out = with_servo(kServoX + kServoY + kRest, "m.toml", both());
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  EXPECT_EQ(*out, "# µ\n[[axis]]\nname = \"X\"\n  servo_gain_m_min_mm = 2.4  # fitted: sd 0.1\n" +
                      kLimits +
                      "feed_forward = 0.25  # fitted: sd 0.01\n[[axis]]\nname = \"Y\"\n"
                      "servo_gain_1_s = 33.3333  # fitted?x\nfeed_forward = 0.5\n" +
                      kLimits + kRest);
  EXPECT_EQ(with_servo(*out, "m.toml", both()), *out);
}

// A lag is added where there was none, 0 too; without one the file's own stays.
TEST(ServoEdit, WritesTheVelocityLag) {
  auto values = both();
  values[0].velocity_lag_s = 0.015;
  values[0].velocity_lag_comment = "fitted: sd 0.1 ms";
  const auto out = with_servo(kServoX + kServoY + kRest, "m.toml", values);
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  EXPECT_THAT(*out, HasSubstr("# fitted: sd 0.1\n  velocity_lag_ms = 15  # fitted: sd 0.1 ms\n"));
  values[0].velocity_lag_s = 0.0;
  values[0].velocity_lag_comment = "";
  const auto none = with_servo(*out, "m.toml", values);
  ASSERT_TRUE(none) << kernel::outcome::text(none.error());
  EXPECT_THAT(*none, HasSubstr("# fitted: sd 0.1\n  velocity_lag_ms = 0\n"));
  const auto own = with_servo(*out, "m.toml", both());
  ASSERT_TRUE(own) << kernel::outcome::text(own.error());
  EXPECT_THAT(*own, HasSubstr("\n  velocity_lag_ms = 15  # fitted: sd 0.1 ms\n"));
  const auto machine = parse(*none, "m.toml");
  ASSERT_TRUE(machine);
  EXPECT_TRUE(machine->axes[0].velocity_lag_known);
  EXPECT_FALSE(machine->axes[1].velocity_lag_known);
}

TEST(ServoEdit, KeepsTheFilesLineEnds) {
  std::string text;
  for (const char c : kServoX + kServoY + kRest) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  const auto out = with_servo(text, "m.toml", both());
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  for (std::size_t i = 0; i < out->size(); ++i) {
    EXPECT_EQ((*out)[i] == '\n', i > 0 && (*out)[i - 1] == '\r') << i;
  }
}

TEST(ServoEdit, RefusesWhatItCannotEdit) {
  const auto refusal = [](const std::string& text, const std::vector<ServoValues>& values) {
    const auto out = with_servo(text, "m.toml", values);
    return out ? "accepted" : kernel::outcome::text(out.error());
  };
  EXPECT_THAT(refusal(kServoX + kServoY + kRest, {{"Z", 40.0, 0.0, "", ""}}),
              HasSubstr("has no axis Z"));
  EXPECT_THAT(refusal(kServoX + kServoY + kRest, {{"X", 4000.0, 0.0, "", ""}}),
              HasSubstr("servo_gain"));
  EXPECT_THAT(refusal("axis = [{name = \"X\", servo_gain_1_s = 50, max_feed_mm_min = 12000, "
                      "max_acceleration_mm_s2 = 2000}, {name = \"Y\", servo_gain_1_s = 50, "
                      "max_feed_mm_min = 12000, max_acceleration_mm_s2 = 2000}]\n" +
                          kRest,
                      {{"X", 40.0, 0.0, "", ""}}),
              HasSubstr("m.toml:1: the servo gain of axis X is not on its own line"));
  EXPECT_THAT(refusal("axis", both()), HasSubstr("m.toml:1"));
}

}  // namespace
}  // namespace steadyrest::passport
