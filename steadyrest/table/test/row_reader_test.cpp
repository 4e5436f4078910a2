// SPDX-License-Identifier: Apache-2.0
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

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The contents of a file: names, rows as numbers, the column `t_s` or its substitute as a clock.
struct Said {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::vector<double> time_s;
  std::string fault;  ///< `LINE: what`, or nothing
  std::string to_do;
  std::vector<Fault> notes;
};

class Keeper final : public Sink {
 public:
  Keeper(Format format, Said& said) : format_(std::move(format)), said_(said) {}

  std::optional<Fault> head(const Head& head) override {
    said_.names = head.name;
    clock_ = Clock::of(head, format_);
    return head.twice();
  }
  std::optional<Fault> row(const Row& row) override {
    std::vector<double> values;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (said_.names[i].empty() || (clock_ && clock_->column() == i)) {
        continue;
      }
      const auto value = row.number(i);
      if (!value) {
        return value.error();
      }
      values.push_back(*value);
    }
    if (clock_) {
      const auto t_s = clock_->seconds(row);
      if (!t_s) {
        return t_s.error();
      }
      said_.time_s.push_back(*t_s);
    }
    said_.rows.push_back(values);
    return std::nullopt;
  }

 private:
  Format format_;
  Said& said_;
  std::optional<Clock> clock_;
};

Said said_by(const std::string& text, const Format& format = {}) {
  Said said;
  Keeper keeper(format, said);
  RowReader reader(format, keeper);
  if (const auto fault = read_rows(text, reader)) {
    said.fault = fmt::format("{}: {}", fault->line, fault->what);
    said.to_do = fault->to_do;
    EXPECT_FALSE(said.to_do.empty());
  }
  said.notes = reader.notes();
  return said;
}

// The same table as different programs write it: marks, quotes, byte order mark, blank lines, a
// separator at the end. All must give the same four numbers.
TEST(RowReader, ReadsWhatLoggersWrite) {
  for (const std::string text : {
           "a,b\n1.5,2\n-3,4e1\n",
           "a;b\n1.5;2\n-3;4e1\n",
           "a\tb\n1.5\t2\n-3\t4e1\n",
           "\xef\xbb\xbf# note\r\n\r\na;b\r\n1,5;2\r\n-3;4e1\r\n",
           "a;b;\n1,5;2;\n-3;4e1;\n",
           "a;b\n1,5;2;\n-3;4e1;",
           "\"a\";\"b\"\n\"1,5\";\"2\"\n\"-3\";\"40\"\n",
           "\"a\",\"b\"\n\"1,5\",\"2\"\n \"-3\" , \"40\" \n",
           "a [-];b [counts]\n1,5;2\n-3;40\n",
           "a;b\n+1,5;+2\n-3,0;4,0e1\n",
       }) {
    const Said said = said_by(text);
    EXPECT_EQ(said.fault, "") << text;
    ASSERT_GE(said.names.size(), 2U) << text;
    EXPECT_EQ(said.names[0] + said.names[1], "ab") << text;
    EXPECT_THAT(said.rows, ElementsAre(ElementsAre(1.5, 2.0), ElementsAre(-3.0, 40.0))) << text;
  }
}

// The comma comes first in the head, but only the semicolon splits both lines into two.
TEST(RowReader, TakesTheSeparatorThatPartsHeadAndFirstRowAlike) {
  const Said said = said_by("Temp, spindle;z\n1,5;2,25\n");
  EXPECT_THAT(said.names, ElementsAre("Temp, spindle", "z"));
  EXPECT_THAT(said.rows, ElementsAre(ElementsAre(1.5, 2.25)));
}

// Four ways to state a unit, and one row in which only some columns have one. A unit that
// contradicts the name is refused: one of the two is wrong by a thousand.
TEST(RowReader, PutsUnitsToTheNames) {
  for (const std::string text : {
           "t [s];z [µm];T1 (°C);spindle [1/min]\n0;1;20;0\n",
           "t;z;T1;spindle\ns;µm;°C;1/min\n0;1;20;0\n",
           "t;z;T1;spindle\n[s];[um];[degC];[rpm]\n0;1;20;0\n",
           "t_s;z_um;T1_c;spindle_rpm\ns;µm;°C;rpm\n0;1;20;0\n",
           "t_s;z;T1_c;spindle\n;µm;;1/min\n0;1;20;0\n",
       }) {
    const Said said = said_by(text);
    EXPECT_EQ(said.fault, "") << text;
    EXPECT_THAT(said.names, ElementsAre("t_s", "z_um", "T1_c", "spindle_rpm")) << text;
    EXPECT_EQ(said.rows.size(), 1U) << text;
  }
  EXPECT_EQ(said_by("t_s;z_um\nms;um\n0;1\n").fault, "2: the unit of t_s is \"ms\"");
  EXPECT_EQ(said_by("t_s;a\nstart;1\n").fault, "2: t_s = \"start\" is not a finite number");
}

TEST(RowReader, DecidesTheDecimalMarkByTheWholeFile) {
  // Read with the wrong mark, every value is wrong by a factor of 1000 and looks sensible. 1,234 is
  // 1.234 where another number of the file proves it, before or after.
  EXPECT_THAT(said_by("a;b\n1,234;0,5\n").rows, ElementsAre(ElementsAre(1.234, 0.5)));
  EXPECT_THAT(said_by("a;b\n1,234;1\n2,345;12,5\n").rows,
              ElementsAre(ElementsAre(1.234, 1.0), ElementsAre(2.345, 12.5)));
  const Said neither = said_by("a;b\n7;1\n1,234;22,345\n");
  EXPECT_THAT(neither.fault,
              HasSubstr("3: the comma may be a decimal mark or a thousands separator"));
  EXPECT_THAT(neither.to_do, HasSubstr("--decimal comma"));
  Format comma;
  comma.decimal = Decimal::comma;
  EXPECT_THAT(said_by("a;b\n1,234;22,345\n", comma).rows, ElementsAre(ElementsAre(1.234, 22.345)));
  EXPECT_THAT(said_by("a;b\n1.5;2\n", comma).fault, HasSubstr("2: a = \"1.5\" has a point"));
  Format point;
  point.decimal = Decimal::point;
  EXPECT_THAT(said_by("a;b\n1,5;2\n", point).fault, HasSubstr("--decimal point is given"));
  EXPECT_THAT(said_by("a;b\n1.5;2\n1,5;2\n").fault,
              HasSubstr("3: a = \"1,5\" has a comma, line 2"));
  EXPECT_THAT(said_by("a;b\n1,5;2\n1.5;2\n").fault,
              HasSubstr("3: a = \"1.5\" has a point, line 2"));
  EXPECT_THAT(said_by("a;b\n1.234,5;2\n").fault, HasSubstr("2: a = \"1.234,5\" is not"));
  EXPECT_THAT(said_by("a;b\n1,234,567;2\n").fault, HasSubstr("2: a = \"1,234,567\" is not"));
}

// Commas for both: a row of 1,5,2 could be 1.5 and 2, or 1 and 5.2. The number of fields reveals
// it, and the file is refused.
TEST(RowReader, NeverTakesADecimalCommaForASeparator) {
  EXPECT_THAT(said_by("a,b\n1,5,2\n").fault, HasSubstr("2: the row has 3 fields, the header 2"));
  EXPECT_THAT(said_by("a,b\n1,5\n2,5,1\n").fault, HasSubstr("3: the row has 3 fields"));
  EXPECT_THAT(said_by("a,b\n1,5\n2\n").fault, HasSubstr("3: the row has 1 fields"));
  EXPECT_THAT(said_by("a,b\n1,5\n2,\n").fault, HasSubstr("3: b is empty"));
}

// Names from the command line: the separator is the one that gives the same number of fields.
TEST(RowReader, ReadsAFileWithoutAHeadWhenItsColumnsAreNamed) {
  Format format;
  format.columns = {"t_s", "-", "count"};
  for (const std::string text :
       {"0 9 5\n0.5 9 6\n", "0,9,5\n0.5,9,6\n", "0;9;5\n0,5;9;6\n", "0\t9\t5\n0,5\t9\t6\n",
        "  0   9  5 \n 0.5\t9  6\n", "0;9;5;\n0,5;9;6;\n", "Zeit;x;n\n0;9;5\n0,5;9;6\n",
        "Zeit;x;n\ns;-;-\n0;9;5\n0,5;9;6\n"}) {
    const Said said = said_by(text, format);
    EXPECT_EQ(said.fault, "") << text;
    EXPECT_THAT(said.time_s, ElementsAre(0.0, 0.5)) << text;
    EXPECT_THAT(said.rows, ElementsAre(ElementsAre(5.0), ElementsAre(6.0))) << text;
    EXPECT_EQ(said.notes.size(), text.starts_with("Zeit") ? 1U : 0U) << text;
  }
  EXPECT_THAT(said_by("0;5\n", format).fault,
              HasSubstr("1: --columns names 3 columns, the row has 2"));
  const Said bare = said_by("0.5,1\n0.6,2\n");
  EXPECT_THAT(bare.fault, HasSubstr("1: there is no header before \"0.5,1\""));
  EXPECT_THAT(bare.to_do, HasSubstr("--columns"));
}

// Sample 12 after 8 and an overrun: with numbers the time is still right, without them nobody knows
// how many samples are missing.
TEST(RowReader, ReadsWhatHalsamplerPrints) {
  Format format;
  format.columns = {"sample", "count", "-"};
  format.sample_hz = 1000.0;
  const Said said =
      said_by("7 100 0.500000 \n8 101 0.500000 \noverrun\n12 105 0.500000 \n", format);
  EXPECT_EQ(said.fault, "");
  EXPECT_THAT(said.time_s, ElementsAre(DoubleEq(0.007), DoubleEq(0.008), DoubleEq(0.012)));
  ASSERT_EQ(said.notes.size(), 1U);
  EXPECT_EQ(said.notes[0].line, 3U);
  format.sample_hz = 0.0;
  EXPECT_THAT(said_by("7 100 1\n", format).to_do, HasSubstr("--sample-hz"));
  Format untagged;
  untagged.columns = {"count"};
  untagged.sample_hz = 500.0;
  untagged.rows_are_samples = true;
  EXPECT_THAT(said_by("100 \n101 \n", untagged).time_s, ElementsAre(0.0, 0.002));
  EXPECT_THAT(said_by("100 \noverrun\n101 \n", untagged).fault,
              HasSubstr("2: the sampler overran"));
}

// Across midnight, and across a change of the stated zone within one hour: seconds count from the
// first day's midnight in UTC.
TEST(RowReader, ReadsStampsWithADate) {
  const Said said = said_by("Zeitstempel;z\n2026-11-22T23:59:59,5;1\n2026-11-23T00:00:00,25;2\n");
  EXPECT_EQ(said.fault, "");
  EXPECT_THAT(said.time_s, ElementsAre(86399.5, 86400.25));
  EXPECT_THAT(said_by("t_s,z\n2026-11-22 10:00:00+01:00,1\n2026-11-22T09:00:01.000001Z,2\n").time_s,
              ElementsAre(32400.0, DoubleEq(32401.000001)));
  EXPECT_THAT(said_by("t_s,z\n2026-11-22 10:00:00Z,1\n2026-11-22 10:00:01,2\n").fault,
              HasSubstr("3: the stamp \"2026-11-22 10:00:01\" has no time zone"));
  EXPECT_THAT(said_by("t_s,z\n2026-11-22 10:00:00,1\n5,2\n").fault,
              HasSubstr("3: \"5\" is not a date and time"));
  const Said leap = said_by("t,z\n2016-12-31T23:59:59Z,1\n2016-12-31T23:59:60Z,2\n");
  EXPECT_THAT(leap.fault, HasSubstr("3: \"2016-12-31T23:59:60Z\" is not a date and time"));
  EXPECT_THAT(leap.to_do, HasSubstr("leave out the row of a leap second"));
  EXPECT_THAT(said_by("t_s,z\n1,1\n2026-11-22 10:00:00,2\n").fault,
              HasSubstr("3: t_s = \"2026-11-22 10:00:00\" is not a finite number"));
}

// Programs write such values for a failed reading; none may become a number.
TEST(RowReader, RefusesWhatIsNoText) {
  EXPECT_EQ(said_by("\x1f\x8b-").fault, "0: is gzip-compressed");
  EXPECT_EQ(said_by(std::string("a,b\n1,\0", 7)).fault, "0: is not text in UTF-8");
  EXPECT_EQ(said_by("a,a\n1,2\n").fault, "1: the column a appears twice");
  EXPECT_THAT(said_by("a\x01,b\n1,2\n").fault, HasSubstr("1: the header has control characters"));
  for (const char* value : {"nan", "inf", "0x10", "1 um", "1e999", "\"\"", "--1", "1e", "open"}) {
    EXPECT_THAT(said_by(fmt::format("a,b\n1,2\n3,{}\n", value)).fault, HasSubstr("3: b")) << value;
  }
  EXPECT_THAT(said_by("").rows, IsEmpty());
}

}  // namespace
}  // namespace steadyrest::table
