// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/record/column_reader.hpp>
#include <steadyrest/record/record_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

std::vector<Sample> write_in_chunks(const std::string& file) {
  test::Random random(7);
  std::vector<Sample> samples;
  const auto writer = test::quiet_writer(file);
  for (int i = 0; i < 300; ++i) {
    samples.push_back(test::any_sample(random));
    test::add(*writer, samples.back());
    if (i % 100 == 99) {
      writer->flush();
    }
  }
  return samples;
}

TEST(ColumnReader, GivesEachChunksColumnsBitForBitInAnyOrder) {
  const test::Folder folder;
  const auto samples = write_in_chunks(folder.file("a.sqlite"));
  auto reader = ColumnReader::open(folder.file("a.sqlite"), {"time_s", "axis.actual_mm.2"}).value();
  ASSERT_EQ(reader.chunks().size(), 3U);
  for (const std::size_t chunk : {2U, 0U, 1U}) {
    EXPECT_EQ(reader.chunks()[chunk].samples, 100U);
    EXPECT_EQ(reader.chunks()[chunk].first_cycle, samples[100 * chunk].frame.cycle);
    ASSERT_TRUE(reader.read(chunk).has_value());
    for (std::size_t i = 0; i < 100; ++i) {
      const auto& frame = samples[100 * chunk + i].frame;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(reader.column(0)[i]),
                std::bit_cast<std::uint64_t>(frame.time_s));
      EXPECT_EQ(std::bit_cast<std::uint64_t>(reader.column(1)[i]),
                std::bit_cast<std::uint64_t>(frame.axis[2].actual_mm));
    }
  }
}

TEST(ColumnReader, RefusesAColumnThatIsNotThereAndWhatIsNoRecord) {
  const test::Folder folder;
  write_in_chunks(folder.file("a.sqlite"));
  EXPECT_FALSE(ColumnReader::open(folder.file("a.sqlite"), {"none"}).value().read(0));
  EXPECT_FALSE(ColumnReader::open(folder.file("b.sqlite"), {"time_s"}));
}

TEST(CopyRecord, IsWholeWhileTheRecordIsWritten) {
  const test::Folder folder;
  test::Random random(7);
  const auto writer = test::quiet_writer(folder.file("a.sqlite"));
  for (int i = 0; i < 100; ++i) {
    test::add(*writer, test::any_sample(random));
  }
  writer->flush();
  ASSERT_TRUE(copy_record(folder.file("a.sqlite"), folder.file("b.sqlite")).has_value());
  auto reader = RecordReader::open(folder.file("b.sqlite"));
  ASSERT_TRUE(reader.has_value()) << reader.error().what;
  EXPECT_EQ(reader->totals().samples, 100U);
  EXPECT_FALSE(reader->totals().closed);
  Sample sample;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(reader->next(sample).value());
  }
}

}  // namespace
}  // namespace steadyrest::record
