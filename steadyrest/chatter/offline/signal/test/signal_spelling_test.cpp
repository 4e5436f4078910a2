// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// Recordings as loggers, oscilloscopes and spreadsheets write them.
namespace steadyrest::chatter::offline::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

RecordedChannels read(const std::string& text, const table::Format& format = {}) {
  auto out = parse_signals(text, "log.csv", format);
  EXPECT_TRUE(out) << text << "\n" << kernel::outcome::text(out.error());
  return out ? std::move(*out) : RecordedChannels(1);
}

std::string refusal(const std::string& text, const table::Format& format = {}) {
  const auto out = parse_signals(text, "log.csv", format);
  return out ? "accepted" : kernel::outcome::text(out.error());
}

table::Format rated(double rate_hz) {
  table::Format out;
  out.sample_hz = rate_hz;
  out.rows_are_samples = true;
  return out;
}

std::string all_notes(const RecordedChannels& channels) {
  std::string out;
  for (const RecordedSignal& channel : channels) {
    for (const std::string& note : channel.notes) {
      out += note + "\n";
    }
  }
  return out;
}

void expect_two(const RecordedChannels& read) {
  ASSERT_EQ(read.size(), 2U);
  EXPECT_NEAR(read[0].rate_hz, 2000.0, 1e-6);
  EXPECT_THAT(read[0].value, ElementsAre(1.5, -0.25, 3.0));
  EXPECT_THAT(read[1].value, ElementsAre(7.0, 8.0, 9.5));
  EXPECT_EQ(read[0].channel, 1U);
  EXPECT_EQ(read[1].channel, 2U);
}

TEST(SignalSpelling, EveryColumnOfNumbersIsAChannelWithItsNameAndUnit) {
  const auto two = read(
      "Time (s),Accel X (m/s^2),State,Mic (V)\n0,1.5,on,7\n0.0005,-0.25,off,8\n0.001,3,on,9.5\n");
  expect_two(two);
  EXPECT_EQ(two[0].name, "Accel X");
  EXPECT_EQ(two[0].unit, "m/s^2");
  EXPECT_EQ(two[0].written, "Accel X (m/s^2)");
  EXPECT_EQ(two[1].name, "Mic");
  EXPECT_EQ(two[1].unit, "V");
  EXPECT_THAT(all_notes(two), HasSubstr("column State has words"));
}

TEST(SignalSpelling, TemperaturesAreLeftOutUnlessTheyAreAllThereIs) {
  const auto one = read("Time (s),Accel (g),Temp (C),Spindle load (%)\n0,1,20,5\n0.001,2,20,6\n");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].name, "Accel");
  EXPECT_THAT(all_notes(one), HasSubstr("Temp (C) is not vibration: not judged"));
  EXPECT_EQ(read("Time (s),Spindle load (%)\n0,5\n0.001,6\n")[0].name, "Spindle load");
}

TEST(SignalSpelling, AGivenRateReplacesTimesThatAreNotEven) {
  const std::string jitters = "Time (s),Mic (V)\n0,1\n0.0007,2\n0.0007,3\n";
  EXPECT_THAT(refusal(jitters), HasSubstr("even steps"));
  const auto rate = read(jitters, rated(2000.0));
  EXPECT_EQ(rate[0].rate_hz, 2000.0);
  EXPECT_THAT(rate[0].value, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(all_notes(rate), HasSubstr("is not even: replaced by 2000 samples a second"));
}

TEST(SignalSpelling, AColumnNamedValueIsTheOnlySignal) {
  const auto one = read("t_s,value,mic\n0,1,5\n0.001,2,6\n");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_THAT(one[0].value, ElementsAre(1.0, 2.0));
  EXPECT_THAT(all_notes(one), HasSubstr("value alone is judged, not mic"));
}

TEST(SignalSpelling, TimesAreKnownByTheirNameAndUnit) {
  struct Case {
    const char* name;
    double per_s;
  };
  for (const Case& one :
       {Case{"t", 1.0}, Case{"T_S", 1.0}, Case{"time", 1.0}, Case{"Time (s)", 1.0},
        Case{"Time [ms]", 1e3}, Case{"time_us", 1e6}, Case{"Timestamp (µs)", 1e6},
        Case{"seconds", 1.0}, Case{"Elapsed Time (sec)", 1.0}, Case{"Zeit (s)", 1.0},
        Case{"X_Value", 1.0}, Case{"milliseconds", 1e3}, Case{"time ms", 1e3}}) {
    std::string text = std::string(one.name) + ",Mic\n";
    for (int i = 0; i < 4; ++i) {
      text += std::to_string(0.001 * i * one.per_s) + ",1\n";
    }
    const auto signal = read(text);
    EXPECT_NEAR(signal[0].rate_hz, 1000.0, 1e-6) << one.name;
    EXPECT_EQ(signal[0].name, "Mic");
  }
  for (const char* other : {"timer", "s", "h", "Time (V)", "temperature (s)"}) {
    EXPECT_THAT(refusal(std::string(other) + ",Mic\n0,1\n0.001,2\n"), HasSubstr("t_s is missing"))
        << other;
  }
  EXPECT_THAT(all_notes(read("time,Mic\n0,1\n0.001,2\n")), HasSubstr("time has no unit"));
}

TEST(SignalSpelling, SpeedsAreKnownByTheirNameAndUnit) {
  struct Case {
    const char* name;
    double rev_s;
  };
  constexpr double kMinute = 1.0 / 60.0;
  for (const Case& one :
       {Case{"speed_rpm", kMinute}, Case{"RPM", kMinute}, Case{"Spindle speed (rpm)", kMinute},
        Case{"n (1/min)", kMinute}, Case{"Drehzahl [U/min]", kMinute}, Case{"S1 (min-1)", kMinute},
        Case{"Spindle Speed", kMinute}, Case{"spindle_rpm", kMinute}, Case{"n (min⁻¹)", kMinute},
        Case{"Spindle speed (rev/s)", 1.0}, Case{"speed_rev_s", 1.0}, Case{"n [Hz]", 1.0}}) {
    const auto signal =
        read("t_s," + std::string(one.name) + ",Mic\n0,600,1\n0.001,-1200,2\n0.002,600,1\n");
    ASSERT_EQ(signal.size(), 1U) << one.name;
    ASSERT_EQ(signal[0].speed_rev_s.size(), 3U) << one.name;
    EXPECT_NEAR(signal[0].speed_rev_s[0], 600.0 * one.rev_s, 1e-9) << one.name;
    EXPECT_NEAR(signal[0].speed_rev_s[1], 1200.0 * one.rev_s, 1e-9) << one.name;
  }
  for (const char* other : {"n", "Speed (mm/s)", "Feed speed", "Tacho (V)", "Line (Hz)"}) {
    const auto signal = read("t_s," + std::string(other) + ",Mic\n0,600,1\n0.001,1200,2\n");
    EXPECT_EQ(signal.size(), 2U) << other;
    EXPECT_TRUE(signal[0].speed_rev_s.empty()) << other;
  }
  EXPECT_THAT(refusal("t_s,n (rpm),S1 (rpm),Mic\n0,1,1,1\n"),
              HasSubstr("log.csv:1: \"n (rpm)\" and \"S1 (rpm)\" may both be the spindle's speed"));
  EXPECT_EQ(read("t_s,n (rpm),speed_rpm,Mic\n0,1,60,1\n0.001,1,60,2\n").back().speed_rev_s.at(0),
            1.0);
}

TEST(SignalSpelling, ReadsWhatASpreadsheetWrites) {
  expect_two(
      read("\xEF\xBB\xBFTime [ms];Accel X (m/s²);Mic (V)\r\n0,0;1,5;7\r\n0,5;-0,25;8\r\n"
           "1,0;3,0;9,5\r\n"));
  expect_two(read("Time\tAccel\tMic\n\nms\tg\tV\n0\t1.5\t7\n0.5\t-0.25\t8\n1\t3\t9.5\n"));
  expect_two(read("\"t_s\",\"a\",\"b\",\n\"0\",1.5,7,\n0.0005,-0.25,8,\n0.001,3,9.5,\n"));
  // Code page 1252.
  EXPECT_EQ(read("Time (\xB5s);a (m/s\xB2)\n0;1\n500;2\n")[0].unit, "m/s²");
}

TEST(SignalSpelling, SkipsWhatLoggersWriteAboveTheHeader) {
  const std::string table = "Time (s),Accel,Mic\n0,1.5,7\n0.0005,-0.25,8\n0.001,3,9.5\n";
  for (const std::string before :
       {"Recorder,Foo 3000\nSample rate,2000\nTime,12:30:05\nDate,2026-11-30\n\n",
        "LabVIEW Measurement\nWriter_Version\t2\n***End_of_Header***\n", "sep=,\n",
        "% made by a program\n# of 2026\nComment: time, place\n"}) {
    const auto two = read(before + table);
    expect_two(two);
    EXPECT_THAT(all_notes(two), HasSubstr("the header is line ")) << before;
  }
  // Refusals count every line of the file.
  EXPECT_THAT(refusal("a\nb,c\n" + table + "0.0015,x,1\n"), HasSubstr("log.csv:7: Accel = \"x\""));
  // A line that names no time column is not a header.
  EXPECT_THAT(refusal("a\nb,c\nmic,accel\n1,2\n3,4\n"), HasSubstr("log.csv:1: "));
}

TEST(SignalSpelling, AHeaderMayBeAComment) {
  expect_two(read("# made by hand\n# time accel mic\n0 1.5 7\n0.0005 -0.25 8\n0.001 3 9.5\n"));
  expect_two(read("%time,accel,mic\n0,1.5,7\n0.0005,-0.25,8\n0.001,3,9.5\n"));
}

TEST(SignalSpelling, WithoutAHeaderTwoColumnsAreTimeAndValue) {
  for (const std::string text :
       {"0,1.5\n0.0005,-0.25\n0.001,3\n", "0\t1.5\n0.0005\t-0.25\n0.001\t3\n",
        "0 1.5\n0.0005 -0.25\n0.001 3\n", "0,0;1,5\n0,0005;-0,25\n0,001;3,0\n"}) {
    const auto signal = read(text);
    EXPECT_NEAR(signal[0].rate_hz, 2000.0, 1e-6);
    EXPECT_THAT(signal[0].value, ElementsAre(1.5, -0.25, 3.0));
    EXPECT_THAT(all_notes(signal), HasSubstr("there is no header"));
  }
  EXPECT_THAT(refusal("1.5\n-0.25\n3\n"),
              HasSubstr("log.csv:1: there is no header before \"1.5\""));
  EXPECT_THAT(refusal("1.5\n-0.25\n3\n"), HasSubstr("--rate-hz"));
  EXPECT_THAT(refusal("0,1\n0.001,2\n0.002,3\n0.0015,2\n"),
              HasSubstr("the first column, without a header the time, advances by"));
  EXPECT_THAT(refusal("0,1,2\n0.1,2,3\n"), HasSubstr("this has 3; name the columns"));
}

TEST(SignalSpelling, AGivenRateNeedsNoTimes) {
  EXPECT_THAT(read("1.5\n-0.25\n3\n", rated(2000.0))[0].value, ElementsAre(1.5, -0.25, 3.0));
  expect_two(read("1.5,7\n-0.25,8\n3,9.5\n", rated(2000.0)));
  const auto named = read("by me\nAccel (g);Mic\n1.5;7\n-0.25;8\n3;9.5\n", rated(2000.0));
  expect_two(named);
  EXPECT_EQ(named[0].name, "Accel");
  // It must not contradict the times.
  expect_two(read("t_s,a,b\n0,1.5,7\n0.0005,-0.25,8\n0.001,3,9.5\n", rated(2000.0)));
  EXPECT_THAT(refusal("t_s,a,b\n0,1.5,7\n0.0005,-0.25,8\n0.001,3,9.5\n", rated(8000.0)),
              HasSubstr("has 2000 samples a second by itself, 8000 are given"));
}

TEST(SignalSpelling, WhatIsNoNumberIsAGap) {
  const auto two = read("t_s,a,b\n0,1,5\n0.001,,6\n0.002,NaN,7\n0.003,-inf,8\n0.004,5,#N/A\n");
  ASSERT_EQ(two.size(), 2U);
  EXPECT_THAT(two[0].value, ElementsAre(1.0, IsNan(), IsNan(), IsNan(), 5.0));
  EXPECT_THAT(two[1].value, ElementsAre(5.0, 6.0, 7.0, 8.0, IsNan()));
  EXPECT_THAT(two[0].notes.back(),
              HasSubstr("a: 3 samples are not numbers, the first in line 3 (0.001 s)"));
  EXPECT_THAT(two[1].notes.back(), HasSubstr("b: 1 sample is not a number, the first in line 6"));
  EXPECT_TRUE(no_signal(read("t_s,value\n0,\n0.001,\n")[0], "log.csv").has_value());
}

TEST(SignalSpelling, MissingSamplesKeepThePlaceOfThoseBehind) {
  std::string text = "t_s,a\n";
  // Stamps of six digits at 44.1 kHz, a gap of 0.9 s: a step taken from two stamps would be off by
  // hundreds of samples.
  constexpr int kGapFrom = 22050;
  constexpr int kGapTo = kGapFrom + 39690;
  constexpr int kEnd = 2 * kGapTo;
  for (int i = 0; i < kEnd; ++i) {
    if (i < kGapFrom || i >= kGapTo) {
      text += std::to_string(i / 44100.0) + "," + std::to_string(i) + "\n";
    }
  }
  const auto one = read(text);
  ASSERT_EQ(one[0].value.size(), static_cast<std::size_t>(kEnd));
  for (int i = 0; i < kEnd; ++i) {
    const double value = one[0].value[static_cast<std::size_t>(i)];
    if (i >= kGapFrom && i < kGapTo) {
      ASSERT_TRUE(std::isnan(value)) << i;
    } else {
      ASSERT_EQ(value, i);
    }
  }
  EXPECT_THAT(all_notes(one), HasSubstr("39690 samples are missing in 1 place, the first before "
                                        "line 22052 (1.4 s)"));
}

TEST(SignalSpelling, RefusesStepsThatAreNoRate) {
  EXPECT_THAT(refusal("t_s,a\n0,1\n1e-97,2\n2e-97,3\n0.5,4\n"),
              HasSubstr("log.csv:5: t_s advances by 0.5 s here and by 1e-97 s elsewhere"));
  EXPECT_THAT(refusal("t_s,a\n0,1\n1e-7,2\n2e-7,3\n"), HasSubstr("1e+07 samples a second"));
}

TEST(SignalSpelling, ASpeedHoldsForASecond) {
  std::string text = "t_s,speed_rpm,a\n0,,1\n";
  for (int i = 1; i < 1500; ++i) {
    text += std::to_string(0.001 * i) + (i == 1 ? ",600," : ",,") + std::to_string(i) + "\n";
  }
  const auto one = read(text);
  const std::vector<double>& speed = one[0].speed_rev_s;
  ASSERT_EQ(speed.size(), 1500U);
  EXPECT_EQ(speed[0], 10.0);
  EXPECT_EQ(speed[1001], 10.0);
  EXPECT_TRUE(std::isnan(speed[1002]));
}

TEST(SignalSpelling, NamesAreSafeToPrint) {
  EXPECT_EQ(shown_name("m/s²"), "m/s²");
  EXPECT_EQ(shown_name("a\x1b[2Jb\xC2\x9B"), "a?[2Jb?");
  EXPECT_EQ(shown_name("\xB5m"), "µm");
  EXPECT_EQ(shown_name(std::string(59, 'a') + "²²").size(), 59U + 3U);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
