// SPDX-License-Identifier: Apache-2.0
// Files as oscilloscopes, controls and spreadsheets write them.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::table {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

/// Times and the numbers of one column.
struct Course {
  std::vector<std::string> names;
  std::vector<double> time_s;
  std::vector<double> value;
  bool dated = false;
  int decimals = 0;
  std::string fault;
  std::vector<Fault> notes;
};

class CourseSink final : public Sink {
 public:
  CourseSink(Format format, std::string column, Course& course)
      : format_(std::move(format)), column_(std::move(column)), course_(course) {}

  std::optional<Fault> head(const Head& head) override {
    course_.names = head.name;
    clock_ = Clock::of(head, format_);
    const auto place = head.place(column_);
    if (!clock_ || !place) {
      return Fault{0, "no clock or no column", "name both"};
    }
    place_ = *place;
    course_.dated = clock_->dated();
    return std::nullopt;
  }
  std::optional<Fault> row(const Row& row) override {
    const auto t_s = clock_->seconds(row);
    const auto value = row.number(place_);
    if (!t_s || !value) {
      return t_s ? value.error() : t_s.error();
    }
    course_.decimals = clock_->decimals(row);
    course_.time_s.push_back(*t_s);
    course_.value.push_back(*value);
    return std::nullopt;
  }

 private:
  Format format_;
  std::string column_;
  Course& course_;
  std::optional<Clock> clock_;
  std::size_t place_ = 0;
};

Course read(const std::string& text, const std::string& column = "z_um",
            const std::vector<std::string>& columns = {}) {
  Course out;
  Format format;
  format.columns = columns;
  CourseSink sink(format, column, out);
  RowReader rows(format, sink);
  if (const auto fault = read_rows(text, rows)) {
    out.fault = fmt::format("{}: {}", fault->line, fault->what);
  }
  out.notes = rows.notes();
  return out;
}

constexpr double kEight_s = 8 * 3600.0;

TEST(RecorderFiles, HaveDateAndTimeInTwoColumns) {
  for (const char* text :
       {"Date;Time;z [µm]\n02.11.2026;08:00:00;1,5\n02.11.2026;08:00:30;-0,5\n",
        "z_um,Time,Date\n1.5,08:00:00,2026-11-02\n-0.5,08:00:30,2026-11-02\n",
        "Datum\tZeit\tz_um\n2.11.2026\t8:00\t1.5\n2.11.2026\t8:00:30.000\t-0.5\n",
        "Date,Time,z_um\n11/22/2026,8:00:00 AM,1.5\n11/22/2026,8:00:30 AM,-0.5\n",
        "Date,Time,z_um\n22-Nov-26,08:00:00:000,1.5\n22-Nov-26,08:00:30:000,-0.5\n"}) {
    const Course course = read(text);
    EXPECT_EQ(course.fault, "") << text;
    EXPECT_THAT(course.time_s, ElementsAre(kEight_s, kEight_s + 30.0)) << text;
    EXPECT_THAT(course.value, ElementsAre(1.5, -0.5)) << text;
    EXPECT_TRUE(course.dated);
  }
  // Past midnight; and a time of day alone is no clock.
  EXPECT_THAT(read("Date,Time,z_um\n31.10.2026,23:59:59,1\n01.11.2026,00:00:01,2\n").time_s,
              ElementsAre(86399.0, 86401.0));
  EXPECT_THAT(read("Time,z_um\n08:00:00,1\n08:00:01,2\n").fault, HasSubstr("no clock"));
  EXPECT_THAT(read("Date,Time,z_um\n02.11.2026,08:00:00,1\n02.11.2026,,2\n").fault,
              HasSubstr("3: \"02.11.2026 \" is not a date and time"));
}

TEST(RecorderFiles, HaveDatesThatTheirRowsExplain) {
  // A proof decides for what follows, even where that alone could be either.
  EXPECT_THAT(read("stamp,z_um\n11/30/2026 23:59:59,1\n12/01/2026 00:00:01,2\n").time_s,
              ElementsAre(86399.0, 86401.0));
  EXPECT_THAT(read("stamp,z_um\n30/11/2026 23:59:59,1\n01/12/2026 00:00:01,2\n").time_s,
              ElementsAre(86399.0, 86401.0));
  EXPECT_THAT(read("stamp,z_um\n02/11/2026 08:00:00,1\n").fault,
              HasSubstr("2: \"02/11/2026 08:00:00\": the day or the month may come first"));
  EXPECT_THAT(read("stamp,z_um\n22/11/2026 08:00:00,1\n11/23/2026 08:00:00,1\n").fault,
              HasSubstr("3: \"11/23/2026 08:00:00\" is not a date and time"));
}

TEST(RecorderFiles, CountMillisecondsAndTimesSince1970) {
  EXPECT_THAT(read("time_ms,z_um\n0,1\n0.5,2\n").time_s, ElementsAre(0.0, DoubleNear(5e-4, 1e-12)));
  EXPECT_EQ(read("time_ms,z_um\n0,1\n5,2\n").decimals, 3);
  EXPECT_THAT(read("Time [ms],z_um\n0,1\n5,2\n").time_s, ElementsAre(0.0, 0.005));
  EXPECT_THAT(read("t_min,z_um\n0,1\n2,2\n").time_s, ElementsAre(0.0, 120.0));
  // 1793606400 s is 2026-11-02 08:00:00.
  for (const char* text : {"timestamp,z_um\n1793606400000,1\n1793606400250,2\n",
                           "timestamp_ms,z_um\n1793606400000,1\n1793606400250,2\n",
                           "time [ms],z_um\n1793606400000,1\n1793606400250,2\n",
                           "Time,z_um\n1793606400,1\n1793606400.25,2\n",
                           "timestamp_us,z_um\n1793606400000000,1\n1793606400250000,2\n"}) {
    const Course course = read(text);
    EXPECT_EQ(course.fault, "") << text;
    EXPECT_THAT(course.time_s, ElementsAre(kEight_s, DoubleNear(kEight_s + 0.25, 1e-9))) << text;
    EXPECT_TRUE(course.dated) << text;
  }
  // A number without a unit that is no year is no time; t_s stays as written.
  EXPECT_THAT(read("time,z_um\n5,1\n6,2\n").fault, HasSubstr("no clock"));
  EXPECT_THAT(read("t_s,z_um\n1793606400,1\n1793606401,2\n").time_s,
              ElementsAre(1793606400.0, 1793606401.0));
}

TEST(RecorderFiles, MayBeInWindowsCodePage) {
  const Course course = read(
      "time [s];z [\xB5m];room [\xB0"
      "C]\n0;1,5;20\n1;2,5;20\n");
  EXPECT_EQ(course.fault, "");
  EXPECT_THAT(course.names, ElementsAre("time_s", "z_um", "room_c"));
  EXPECT_THAT(course.value, ElementsAre(1.5, 2.5));
  ASSERT_EQ(course.notes.size(), 1U);
  EXPECT_THAT(course.notes[0].what, HasSubstr("not UTF-8"));
  EXPECT_TRUE(read("time [s];z [µm]\n0;1,5\n1;2,5\n").notes.empty());
  EXPECT_EQ(from_cp1252("\xB5\xB2\xE4\x80"), "µ²ä?");
  EXPECT_TRUE(is_utf8("µ²ä€"));
  for (const char* text : {"\xB5", "\xC2", "a\xE2\x82", "\xC0\xB5", "\xF8\x80\x80\x80"}) {
    EXPECT_FALSE(is_utf8(text));
  }
}

TEST(RecorderFiles, MayHaveWordsInColumnsThatAreSkipped) {
  const std::vector<std::string> columns = {"-", "-", "-", "t_s", "z_um", "-"};
  const std::string rows =
      "Record Length,2.5e+03,,0.0,1.5,\nSample Interval,4e-4,,0.5,2.5,\n,,,1.0,3.5,\n";
  const Course course = read(rows, "z_um", columns);
  EXPECT_EQ(course.fault, "");
  EXPECT_THAT(course.time_s, ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(course.value, ElementsAre(1.5, 2.5, 3.5));
  EXPECT_THAT(
      read("Record Length;;0,5;1,5\nSource;CH1;1,0;2,5\n", "z_um", {"-", "-", "t_s", "z_um"}).value,
      ElementsAre(1.5, 2.5));
}

TEST(RecorderFiles, MayHaveSettingsAboveTheRows) {
  const std::string rows = "0,1.5\n0.5,2.5\n";
  for (const char* above :
       {"Model,MSO4034\nFirmware Version,2.48\n\nPoint Format,Y,,\nHorizontal Units,S\nTIME,CH1\n",
        "Rate: 2 Hz\nChannel 1; z; micrometres\nTIME,CH1\ns,um\n", "TIME,CH1\n"}) {
    const Course course = read(above + rows, "z_um", {"t_s", "z_um"});
    EXPECT_EQ(course.fault, "") << above;
    EXPECT_THAT(course.value, ElementsAre(1.5, 2.5)) << above;
    ASSERT_EQ(course.notes.size(), 1U);
    EXPECT_EQ(course.notes[0].line, 1U);
  }
  // Endless words are no settings, rows of another size none either.
  std::string words;
  for (int i = 0; i < 100; ++i) {
    words += "word\n";
  }
  EXPECT_THAT(read(words + rows, "z_um", {"t_s", "z_um"}).fault,
              HasSubstr("65: --columns names 2 columns, the row has 1: \"word\""));
  EXPECT_THAT(read("TIME,CH1,CH2\n0,1,2\n", "z_um", {"t_s", "z_um"}).fault,
              HasSubstr("2: --columns names 2 columns, the row has 3"));
  EXPECT_THAT(read("no more than words\n", "z_um", {"t_s", "z_um"}).fault,
              HasSubstr("1: --columns names 2 columns, the row has 4"));
}

}  // namespace
}  // namespace steadyrest::table
