// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/record/tables/record_table.hpp>
#include <steadyrest/record/test/samples.hpp>

// Command line and page share these tables; what is in them is tested there and in record/hdf5.
namespace steadyrest::record::tables {
namespace {

class RecordTable : public testing::Test {
 protected:
  RecordTable() {
    test::Random random(5);
    const auto writer = test::quiet_writer(folder.file("run.sqlite"));
    for (int i = 0; i < 100; ++i) {
      test::add(*writer, test::any_sample(random));
    }
  }
  RecordReader reader() { return RecordReader::open(folder.file("run.sqlite")).value(); }

  test::Folder folder;
};

TEST_F(RecordTable, HasAHeadAndALineForEachSample) {
  std::string text;
  auto from = reader();
  const auto samples = write_csv(
      from, [&text](std::string_view line) { text += line; }, [](std::uint64_t) { return true; },
      {});
  EXPECT_EQ(samples.value(), 100U);
  EXPECT_EQ(std::ranges::count(text, '\n'), 101);
  EXPECT_TRUE(text.starts_with(kCsvHead));
}

TEST_F(RecordTable, EndsWhenItIsTold) {
  const auto few = [](std::uint64_t samples) { return samples < 10; };
  std::string text;
  auto from = reader();
  EXPECT_FALSE(write_csv(from, [&text](std::string_view line) { text += line; }, few, {}));
  EXPECT_EQ(std::ranges::count(text, '\n'), 11);
  auto again = reader();
  EXPECT_FALSE(write_hdf5(again, folder.file("run.h5"), few, {}));
}

}  // namespace
}  // namespace steadyrest::record::tables
