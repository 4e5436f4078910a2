// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/log/test/log_text.hpp>

namespace steadyrest::thermal::offline {
namespace {

namespace fs = std::filesystem;
using test::kRows;
using test::log_text;
using test::parsed;
using test::Row;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ThermalLog, IsReadInInnerUnits) {
  const Log log = parsed(log_text());
  ASSERT_EQ(log.rows(), 400U);
  EXPECT_EQ(log.time_s[3], 180.0);
  EXPECT_EQ(log.speed_rev_s[3], 25.0);
  ASSERT_EQ(log.displacement.size(), 1U);
  EXPECT_EQ(log.displacement[0].name, "z_um");
  EXPECT_NEAR(log.displacement[0].value[10], 1e-3, 1e-12);
  ASSERT_EQ(log.temperature.size(), 1U);
  EXPECT_NEAR(log.temperature[0].value[10], 20.1, 1e-12);
  EXPECT_THAT(log.gap, IsEmpty());
  EXPECT_THAT(log.notes, IsEmpty());
}

// The same day in minutes, millimetres and degrees Fahrenheit.
TEST(ThermalLog, UnitsAreConvertedByName) {
  const auto other = [](int i, Row& row) {
    row.time_s = i;
    row.z = fmt::format("{:.7f}", 0.0001 * i);
    row.t = fmt::format("{:.3f}", 68.0 + 0.018 * i);
  };
  const Log a = parsed(log_text());
  const Log c = parsed(log_text(other, "t_min,spindle_rpm,z_mm,t1_f"));
  for (std::size_t i = 0; i < a.rows(); ++i) {
    EXPECT_NEAR(c.time_s[i], a.time_s[i], 1e-9);
    EXPECT_NEAR(c.displacement[0].value[i], a.displacement[0].value[i], 1e-9);
    EXPECT_NEAR(c.temperature[0].value[i], a.temperature[0].value[i], 1e-3);
  }
}

// Packed here with zlib itself, so the reader is tested against the format and not against itself.
TEST(ThermalLog, PackedIsThePlainOne) {
  const kernel::file::testing::OwnFolder folder;
  const std::string path = folder.at("log.csv.gz");
  const std::string text = log_text();
  const gzFile out = gzopen(path.c_str(), "wb");
  ASSERT_EQ(gzwrite(out, text.data(), static_cast<unsigned>(text.size())),
            static_cast<int>(text.size()));
  gzclose(out);
  const auto log = read_log(path);
  ASSERT_TRUE(log.has_value()) << log.error().what;
  EXPECT_EQ(log->displacement[0].value, parsed(text).displacement[0].value);
}

TEST(ThermalLog, AnAbsentSensorIsLeftOutAndSaidSo) {
  const Log log = parsed(log_text([](int i, Row& row) { row.t = i % 3 == 0 ? row.t : "NaN"; }));
  EXPECT_THAT(log.temperature, IsEmpty());
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:1: t1_c has no value in 66 %")));
}

TEST(ThermalLog, ShortHolesOfATemperatureAreBridged) {
  const Log log = parsed(log_text([](int i, Row& row) { row.t = i > 20 && i < 28 ? "" : row.t; }));
  ASSERT_EQ(log.temperature.size(), 1U);
  // Rows 21 to 27 are missing: eight minutes, on the straight line between their neighbours.
  EXPECT_NEAR(log.temperature[0].value[25], 20.25, 1e-9);
  EXPECT_THAT(log.notes, IsEmpty());
}

// An invented reading would count as a measured one; an invented temperature only feeds the model.
TEST(ThermalLog, HolesOfADisplacementStayHoles) {
  const Log log = parsed(log_text([](int i, Row& row) { row.z = i == 30 ? "" : row.z; }));
  EXPECT_TRUE(std::isnan(log.displacement[0].value[30]));
  EXPECT_FALSE(std::isnan(log.displacement[0].value[31]));
}

TEST(ThermalLog, HolesOfADisplacementAreCountedInANote) {
  const Log log = parsed(log_text([](int i, Row& row) { row.z = i % 5 == 3 ? "nan" : row.z; }));
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:5: z_um has no reading in 80 of 400 rows, "
                                               "from here on; it is fitted without them")));
}

TEST(ThermalLog, AStuckProbeCountsForNothingWhileItIsStuck) {
  const Log log = parsed(log_text([](int i, Row& row) { row.z = i > 260 ? "6.0000" : row.z; }));
  ASSERT_EQ(log.displacement.size(), 1U);
  EXPECT_FALSE(std::isnan(log.displacement[0].value[260]));
  EXPECT_TRUE(std::isnan(log.displacement[0].value[300]));
  // Row 261 is line 263: one for the header, and lines count from 1.
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:263: z_um is stuck")));
  const Log rest = parsed(log_text([](int i, Row& row) { row.z = i > 290 ? "9.0000" : row.z; }));
  EXPECT_FALSE(std::isnan(rest.displacement[0].value[350])) << "under two hours may be rest";
  EXPECT_THAT(rest.notes, IsEmpty());
}

// 0.1 K in a room that drifts by 0.06 K an hour: hours of the same value, and all of them true.
TEST(ThermalLog, ACoarseSensorIsNotStuck) {
  const Log log =
      parsed(log_text([](int i, Row& row) { row.t = fmt::format("{:.1f}", 20.0 + 0.001 * i); }));
  ASSERT_EQ(log.temperature.size(), 1U);
  EXPECT_FALSE(std::isnan(log.temperature[0].value[100]));
}

TEST(ThermalLog, AGapIsFoundAndSaid) {
  const Log log = parsed(log_text([](int i, Row& row) { row.time_s += i < 50 ? 0.0 : 1800.0; }));
  EXPECT_THAT(log.gap, ElementsAre(50U));
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:52: 31.0 min are missing")));
}

TEST(ThermalLog, ThreeRowsBehindAGapVouchForTheirTimes) {
  const auto behind = [](int rows) {
    return parse_log(
        log_text([rows](int i, Row& row) { row.time_s += i < kRows - rows ? 0.0 : 3e5; }), "d.csv");
  };
  // Two rows may share one error; three that agree on a new time are a restart.
  ASSERT_TRUE(behind(3).has_value());
  ASSERT_FALSE(behind(2).has_value());
  EXPECT_EQ(behind(2).error().line, 400U);
}

TEST(ThermalLog, MinutesCountFromTheFirstStamp) {
  EXPECT_EQ(parsed(log_text({}, "time_s,spindle_rpm,z_um,t1_c")).origin_s, 0.0);
  std::string text = "when,spindle_rpm,z_um\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("1970-01-02T10:{:02}:00Z,0,{}\n", i, 3 * i);
  }
  EXPECT_EQ(parsed(text).origin_s, 34.0 * 3600.0);
}

// A logger that flushes twice.
TEST(ThermalLog, RowsThatStandTwiceAreTakenOnce) {
  std::string text = log_text();
  const std::size_t at = text.find("\n600,") + 1;
  const std::string row = text.substr(at, text.find('\n', at) + 1 - at);
  text.insert(at, row);
  const Log log = parsed(text);
  EXPECT_EQ(log.rows(), 400U);
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:13: 1 rows appear twice")));
}

TEST(ThermalLog, ColumnsWithoutAUnitArePassedOverAndNamed) {
  const Log log = parsed(log_text({}, "time_s,spindle_rpm,z_um,load"));
  EXPECT_THAT(log.temperature, IsEmpty());
  EXPECT_THAT(log.notes,
              ElementsAre(HasSubstr("day.csv:1: columns whose names end in no known unit")));
}

TEST(ThermalLog, NoFileIsRefused) {
  EXPECT_FALSE(read_log("/no/such/log.csv").has_value());
  EXPECT_FALSE(read_log("/tmp").has_value());
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Each file states `refuse LINE: words of the refusal` in its first line, a comment; empty and
/// packed ones cannot.
TEST(ThermalLogCorpus, EveryFileIsRefusedWhereItSays) {
  std::set<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STEADYREST_SOURCE_DIR) / "tests/refused/thermal-log")) {
    files.insert(entry.path());
  }
  EXPECT_GE(files.size(), 40U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename());
    const auto log = read_log(file.string());
    ASSERT_FALSE(log.has_value());
    EXPECT_EQ(log.error().file, file.string());
    EXPECT_FALSE(log.error().to_do.empty());
    if (file.extension() == ".gz") {
      EXPECT_THAT(log.error().what, HasSubstr("truncated or damaged"));
      continue;
    }
    const std::string text = text_of(file);
    const std::size_t at = text.find("refuse ");
    if (at == std::string::npos) {
      EXPECT_TRUE(text.empty());
      continue;
    }
    const std::string said = text.substr(at + 7, text.find('\n', at) - at - 7);
    const std::size_t colon = said.find(": ");
    EXPECT_EQ(log.error().line, std::stoul(said)) << log.error().what;
    EXPECT_THAT(log.error().what, HasSubstr(said.substr(colon + 2)));
  }
}

/// 40.1 h of a spindle unit, whole or every twentieth row.
TEST(ThermalLog, TheRecordedSpindleUnitIsReadWhole) {
  const fs::path whole = kernel::file::testing::shared_data() / "thermal/spindle_unit.csv.gz";
  const bool is_whole = fs::exists(whole);
  const auto log =
      read_log((is_whole ? whole : kernel::file::testing::excerpt("spindle-unit")).string());
  ASSERT_TRUE(log.has_value()) << log.error().what;
  EXPECT_EQ(log->rows(), is_whole ? 9625U : 482U);
  EXPECT_NEAR(log->hours(), 40.1, 0.02);
  EXPECT_EQ(log->displacement.size(), 5U);
  EXPECT_EQ(log->temperature.size(), 16U);
  EXPECT_THAT(log->gap, IsEmpty());
  EXPECT_THAT(log->notes, IsEmpty());
}

}  // namespace
}  // namespace steadyrest::thermal::offline
