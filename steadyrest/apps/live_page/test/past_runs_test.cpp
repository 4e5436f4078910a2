// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/past_runs/course.hpp>
#include <steadyrest/apps/live_page/past_runs/export.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/record/database.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/record/tables/record_table.hpp>
#include <steadyrest/trial/replay/derived_columns.hpp>

namespace steadyrest::apps::live_page::past_runs {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using record::RecordReader;
using record::RecordWriter;

constexpr double kFirst_s = 100.0;

/// mm/min in the sample i; each value comes once.
double speed(std::size_t i) {
  return static_cast<double>((i * 7919) % 100'003);
}

/// A record with chunks of 1000 samples, 1 ms apart.
class PastRun : public testing::Test {
 protected:
  void write(std::size_t samples) {
    if (!writer) {
      writer = RecordWriter::make({.file = file,
                                   .info = {.machine = "mill", .cycle_s = 0.001},
                                   .commit_s = 3600.0,
                                   .drain_s = 3600.0})
                   .value();
    }
    for (; written < samples; ++written) {
      kernel::signal::Frame frame{};
      frame.time_s = kFirst_s + 1e-3 * static_cast<double>(written);
      frame.cycle = written;
      frame.path_speed_mm_s = speed(written) / 60.0;
      writer->add(frame, {});
      if (written % 1000 == 999) {
        writer->flush();
      }
    }
    writer->flush();
  }
  Json course(double from_s, double to_s, std::size_t points) {
    auto got =
        course_of({.file = file, .from_s = from_s, .to_s = to_s, .points = points}, overviews);
    EXPECT_TRUE(got.has_value()) << kernel::outcome::text(got.error());
    return got.value_or(Json());
  }
  /// Of the samples in [from, to).
  static double most(std::size_t from, std::size_t to) {
    double out = -std::numeric_limits<double>::infinity();
    for (std::size_t i = from; i < to; ++i) {
      out = std::max(out, speed(i));
    }
    return out;
  }
  web::Response exported(const std::string& format, double most_bytes = 1e9) {
    return export_record(
        {.file = file, .name = "run.sqlite", .format = format, .most_bytes = most_bytes}, {});
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(
        std::ranges::distance(std::filesystem::directory_iterator(folder.path())));
  }

  OwnFolder folder;
  std::string file = folder.at("run.sqlite");
  std::unique_ptr<RecordWriter> writer;
  std::size_t written = 0;
  Overviews overviews;
};

TEST_F(PastRun, ShortStretchesShowEachSample) {
  write(20'000);
  const Json got = course(10.4995, 10.5095, 10);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(got["t_s"][i], 10.5 + 1e-3 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(got["columns"]["path_speed_mm_min"]["max"][i], speed(10'500 + i), 1e-6);
    EXPECT_NEAR(got["columns"]["path_speed_mm_min"]["min"][i], speed(10'500 + i), 1e-6);
  }
}

TEST_F(PastRun, LongStretchesShowTheLargestOfEachIntervalAndOfItsEdgesAtMost) {
  write(40'000);
  const Json got = course(0.0, 1e18, 20);  // intervals of 2 s
  for (std::size_t i = 0; i < 20; ++i) {
    const double shown = got["columns"]["path_speed_mm_min"]["max"][i];
    EXPECT_GE(shown, most(2000 * i + 1, 2000 * i + 1999) * (1.0 - 1e-6));
    const std::size_t low = std::max<std::size_t>(2000 * i, 300) - 300;
    EXPECT_LE(shown, most(low, std::min<std::size_t>(2000 * i + 2300, 40'000)) * (1.0 + 1e-6));
  }
}

// Once the run is known, nothing but the stretch itself is read.
TEST_F(PastRun, TheEndIsShownWithoutTheBeginning) {
  write(20'000);
  static_cast<void>(course(0.0, 1e18, 10));
  writer.reset();
  auto database = record::Database::open_to_change(file).value();
  ASSERT_TRUE(database.run("UPDATE chunk_column SET data = x'00' WHERE chunk = 1"));
  EXPECT_NEAR(course(18.9995, 19.0095, 10)["columns"]["path_speed_mm_min"]["max"][3], speed(19'003),
              1e-6);
  EXPECT_FALSE(
      course_of({.file = file, .from_s = 0.0, .to_s = 0.01, .points = 10}, overviews).has_value());
}

TEST_F(PastRun, GrowsWhileItIsWritten) {
  write(5'000);
  EXPECT_NEAR(course(0.0, 1e18, 10)["t_s"][9], 4.75, 0.01);
  write(10'000);
  EXPECT_NEAR(course(0.0, 1e18, 10)["t_s"][9], 9.5, 0.01);
  EXPECT_NEAR(course(9.9985, 9.9995, 1)["columns"]["path_speed_mm_min"]["max"][0], speed(9'999),
              1e-6);
}

TEST_F(PastRun, ASecondFileOfTheSameNameIsAnother) {
  write(5'000);
  static_cast<void>(course(0.0, 1e18, 10));
  writer.reset();
  std::filesystem::rename(file, folder.at("old.sqlite"));  // keeps its inode in use
  written = 0;
  write(1'000);
  EXPECT_NEAR(course(0.0, 1e18, 10)["t_s"][9], 0.95, 0.01);
}

TEST_F(PastRun, IsExportedAsTheCommandLineDoes) {
  write(3'000);
  std::string table;
  auto reader = RecordReader::open(file).value();
  ASSERT_TRUE(record::tables::write_csv(
      reader, [&table](std::string_view line) { table += line; }, [](auto) { return true; },
      trial::replay::derived_columns(reader.run())));
  const std::size_t before = files();
  {
    const auto csv = exported("csv");
    EXPECT_EQ(text_of_file(csv.file), table);
    EXPECT_EQ(csv.head[0].second, "attachment; filename=\"run.csv\"");
    const auto sqlite = exported("");
    EXPECT_EQ(RecordReader::open(sqlite.file).value().totals().samples, 3000U)
        << "also while it is written";
    if (record::tables::has_hdf5()) {
      EXPECT_TRUE(text_of_file(exported("hdf5").file).starts_with("\x89HDF\r\n\x1a\n"));
    } else {
      EXPECT_EQ(exported("hdf5").status, 422U);
    }
  }
  EXPECT_EQ(files(), before) << "no file is left";
}

TEST_F(PastRun, TakesNoMoreRoomThanItMay) {
  write(10'000);
  const std::size_t before = files();
  EXPECT_EQ(exported("csv", 1e6).status, 413U);
  EXPECT_EQ(exported("sqlite", 1e3).status, 413U);
  EXPECT_EQ(files(), before);
}

TEST_F(PastRun, IsNotExportedWhenThePageEnds) {
  write(3'000);
  std::stop_source stop;
  stop.request_stop();
  const std::size_t before = files();
  EXPECT_EQ(
      export_record({.file = file, .name = "run.sqlite", .format = "csv"}, stop.get_token()).status,
      422U);
  EXPECT_FALSE(course_of({.file = file}, overviews, stop.get_token()).has_value());
  EXPECT_EQ(files(), before);
}

TEST_F(PastRun, HasNoOtherFormat) {
  write(10);
  const auto got = exported("parquet");
  EXPECT_EQ(got.status, 422U);
  EXPECT_THAT(got.body, testing::HasSubstr("csv, hdf5, sqlite"));
}

}  // namespace
}  // namespace steadyrest::apps::live_page::past_runs
