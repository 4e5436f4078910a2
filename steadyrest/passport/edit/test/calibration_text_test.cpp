// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/edit/calibration_text.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/keys/schema.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Encoder;

using testing::HasSubstr;

/// A file with everything that byte editing can trip over: two-byte characters before and in the
/// edited lines, comments after heads and keys, an indented section, an axis without an encoder, a
/// last line without a line end.
const std::string kHead = "name = \"µ\" # a comment\n[control]\ndialect = \"linuxcnc\"\n\n";
const std::string kX =
    "[[axis]] # X\nname = \"X\" # größer µm\nservo_gain_1_s = 50\nmax_feed_mm_min = 12000\n"
    "max_acceleration_mm_s2 = 2000\n";
const std::string kEncoder = "  [axis.encoder]   # glass\n  count_um = 1 # µm, ×4\n";
const std::string kB =
    "\n[[axis]]\nname = \"B\"\nservo_gain_1_s = 50\nmax_speed_deg_s = 180\n"
    "max_acceleration_deg_s2 = 360\n[axis.friction]\nviscous_1_s = 1\n";
const std::string kTail = "\n[override.feed]\npercent = [0, 50, 100]";

/// Line −3 to begin with: tables may reach below the scale's zero. sin(i²) repeats nowhere, so a
/// shifted table would show.
Encoder learnt(std::size_t lines) {
  Encoder out;
  // The four phase errors sum to 0: they are measured against their own mean.
  out.phase_error_au = {3.012e-5, -5e-5, 4.4e-5, -2.412e-5};
  out.line_table_first = -3;
  for (std::size_t i = 0; i < lines; ++i) {
    out.line_table_au.push_back(2e-5 * std::sin(static_cast<double>(i * i)));
  }
  return out;
}

std::string refusal_of(const std::string& text, std::string_view axis, const Encoder& encoder) {
  const auto out = with_calibration(text, "m.toml", axis, encoder);
  return out ? "accepted" : kernel::outcome::text(out.error());
}

/// Three claims at once: the surroundings of the calibration are untouched byte for byte; the
/// calibration reads back to half a printed digit; and a second run changes nothing.
void expect_put_in(const std::string& text, std::string_view axis, std::size_t index,
                   const Encoder& encoder, const std::string& before, const std::string& after) {
  const auto out = with_calibration(text, "m.toml", axis, encoder);
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  EXPECT_TRUE(out->starts_with(before)) << *out;
  EXPECT_TRUE(out->ends_with(after)) << *out;
  const auto machine = parse(*out, "m.toml");
  ASSERT_TRUE(machine);
  const Encoder& read = machine->axes[index].encoder;
  ASSERT_EQ(read.line_table_au.size(), encoder.line_table_au.size());
  for (std::size_t i = 0; i < read.line_table_au.size(); ++i) {
    EXPECT_NEAR(read.line_table_au[i], encoder.line_table_au[i], 0.5001e-5 * encoder.count_au);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(read.phase_error_au.at(i), encoder.phase_error_au[i], 1e-8 * encoder.count_au);
  }
  EXPECT_EQ(read.line_table_first, encoder.line_table_first);
  // Again: now all keys are there and only their values change, to the same ones.
  const auto again = with_calibration(*out, "m.toml", axis, encoder);
  ASSERT_TRUE(again) << kernel::outcome::text(again.error());
  EXPECT_EQ(*again, *out);
}

TEST(CalibrationText, GoesBehindTheEncodersKeysAndLeavesTheRestAsItWas) {
  expect_put_in(kHead + kX + kEncoder + kB + kTail, "X", 0, learnt(100), kHead + kX + kEncoder,
                kB + kTail);
}

// A single bare \n would show an edit that ignored the file's line ends.
TEST(CalibrationText, KeepsTheFilesLineEnds) {
  std::string text;
  for (const char c : kHead + kX + kEncoder + kB + kTail) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  const auto out = with_calibration(text, "m.toml", "X", learnt(100));
  ASSERT_TRUE(out) << kernel::outcome::text(out.error());
  for (std::size_t i = 0; i < out->size(); ++i) {
    EXPECT_TRUE((*out)[i] != '\n' || (*out)[i - 1] == '\r') << i;
  }
}

TEST(CalibrationText, MakesTheSectionOfAnAxisThatHasNone) {
  expect_put_in(kHead + kX + kB + kTail, "X", 0, learnt(3), kHead + kX + "[axis.encoder]\n",
                kB + kTail);
}

// Written in degrees, kept in rad: a factor of 57 if one of the two conversions were missing.
TEST(CalibrationText, TakesARotaryAxisInDegrees) {
  const double kDegree = 3.14159265358979 / 180.0;
  Encoder encoder = learnt(8);
  encoder.count_au = 0.001 * kDegree;
  encoder.line_table_periodic = true;
  encoder.line_table_first = 0;
  for (double& e : encoder.phase_error_au) {
    e *= kDegree;
  }
  for (double& e : encoder.line_table_au) {
    e *= kDegree;
  }
  const std::string b = kB + "[axis.encoder]\ncount_deg = 0.001\n";
  expect_put_in(kHead + kX + b + kTail, "B", 3, encoder, kHead + kX + b, kTail);
}

// 1000 lines replaced by 5: the bytes after the list must move up without a gap.
TEST(CalibrationText, ReplacesAnOlderOneOfAnotherLength) {
  const auto first =
      with_calibration(kHead + kX + kEncoder + kB + kTail, "m.toml", "X", learnt(1000));
  ASSERT_TRUE(first);
  expect_put_in(*first, "X", 0, learnt(5), kHead + kX + kEncoder, kB + kTail);
}

// The editor must refuse what it cannot place safely; each text here would otherwise be changed in
// the wrong place or into a file that does not load.
TEST(CalibrationText, RefusesWhatItCannotDoSafely) {
  const std::string inlined = kHead + kX + "encoder = {count_um = 1}\n" + kB + kTail;
  EXPECT_THAT(refusal_of(inlined, "X", learnt(3)), HasSubstr("inline or with dotted keys"));
  const std::string dotted = kHead + kX + "encoder.count_um = 1\n" + kB + kTail;
  EXPECT_THAT(refusal_of(dotted, "X", learnt(3)), HasSubstr("inline or with dotted keys"));
  const std::string good = kHead + kX + kEncoder + kB + kTail;
  EXPECT_THAT(refusal_of(good, "Z", learnt(3)), HasSubstr("has no axis Z"));
  EXPECT_THAT(refusal_of(good + "\nnonsense", "X", learnt(3)), HasSubstr("m.toml:"));
  Encoder other = learnt(3);
  other.count_au = 0.002;
  EXPECT_THAT(refusal_of(good, "X", other), HasSubstr("has a count of 0.001 mm"));
  Encoder wild = learnt(3);
  wild.line_table_au[1] = 0.5;
  EXPECT_THAT(refusal_of(good, "X", wild), HasSubstr("line_table_um"));
}

// The last five are no calibrations: a wrong key, an error of a whole count, broken TOML, nothing,
// another count.
TEST(CalibrationText, AFragmentReadsBack) {
  const Encoder encoder = learnt(50);
  const auto read =
      parse_calibration("# learnt\n" + calibration_text(encoder, false), "f.toml", "", 0.001);
  ASSERT_TRUE(read) << kernel::outcome::text(read.error());
  EXPECT_EQ(read->line_table_au.size(), 50U);
  EXPECT_NEAR(read->line_table_au[7], encoder.line_table_au[7], 1e-8);
  EXPECT_FALSE(parse_calibration("line_table = [1]\n", "f.toml", "", 0.001));
  EXPECT_FALSE(parse_calibration("line_table_um = [1]\n", "f.toml", "", 0.001));
  EXPECT_FALSE(parse_calibration("line_table_um = [0.1\n", "f.toml", "", 0.001));
  EXPECT_FALSE(parse_calibration("", "f.toml", "", 0.001));
  EXPECT_FALSE(parse_calibration("count_um = 2\n", "f.toml", "", 0.001));
}

// Scales have 10⁵ lines and more; a reader that copied the list for each element would take
// minutes.
TEST(CalibrationText, AFileWithAHundredThousandLinesIsReadWhole) {
  const Encoder encoder = learnt(100'000);
  const auto machine =
      parse(kHead + kX + kEncoder + calibration_text(encoder, false) + kTail + kB, "m.toml");
  ASSERT_TRUE(machine) << kernel::outcome::text(machine.error());
  const auto& read = machine->axes[0].encoder.line_table_au;
  ASSERT_EQ(read.size(), 100'000U);
  EXPECT_NEAR(read.front(), encoder.line_table_au.front(), 0.5001e-5 * encoder.count_au);
  EXPECT_NEAR(read.back(), encoder.line_table_au.back(), 0.5001e-5 * encoder.count_au);
}

// The limit from both sides.
TEST(CalibrationText, TakesTheLongestTableAndNotALongerOne) {
  const std::string head = kHead + kX + kEncoder;
  EXPECT_TRUE(parse(head + calibration_text(learnt(kMaxLineTable), false) + kB + kTail, "m.toml"));
  EXPECT_FALSE(
      parse(head + calibration_text(learnt(kMaxLineTable + 1), false) + kB + kTail, "m.toml"));
}

}  // namespace
}  // namespace steadyrest::passport
