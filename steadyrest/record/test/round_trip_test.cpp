// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

using kernel::signal::PathSegment;

// These bindings compile for exactly this many fields: whoever adds one to a frame is sent here,
// and so to columns.hpp.
TEST(Columns, NameEveryField) {
  [[maybe_unused]] const auto& [f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12, f13, f14, f15,
                                f16, f17, f18, f19, f20, f21, f22, f23, f24, f25, f26, f27, f28,
                                f29] = kernel::signal::Frame{};
  [[maybe_unused]] const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12] =
      kernel::signal::AxisSample{};
  [[maybe_unused]] const auto& [o1, o2, o3, o4] = kernel::signal::OverrideState{};
  [[maybe_unused]] const auto& [p1, p2, p3, p4] = kernel::signal::ProbeReading{};
  [[maybe_unused]] const auto& [c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14] =
      kernel::signal::Command{};
  [[maybe_unused]] const auto& [s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14, s15,
                                s16, s17, s18, s19, s20, s21, s22] = PathSegment{};
  [[maybe_unused]] const auto& [k1, k2, k3, k4, k5, k6, k7] = kernel::port::Capability{};
  std::size_t columns = 0;
  Sample sample;
  sample_columns(sample, [&columns](const ColumnName&, auto&) { ++columns; });
  // Of the sample itself 4; of the frame 20 single ones; of the command 12 single ones.
  EXPECT_EQ(columns, 4 + 20 + 8 * 12 + 3 * 4 + 16 + 4 + 12 + 2 * 8U);
}

TEST(RoundTrip, EveryFieldComesBackBitForBit) {
  const test::Folder folder;
  test::Random random(1);
  std::vector<Sample> samples;
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    for (int i = 0; i < 300; ++i) {
      samples.push_back(test::any_sample(random));
      test::add(*writer, samples.back());
      if (i % 100 == 50) {
        writer->flush();
      }
    }
  }
  auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_EQ(reader.totals().samples, 300U);
  EXPECT_TRUE(reader.totals().closed);
  Sample read;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_TRUE(reader.next(read).value());
    EXPECT_EQ(read.number, i);
    EXPECT_EQ(test::bits_of(read), test::bits_of(samples[i])) << i;
    EXPECT_EQ(read.frame.vibration.size(), samples[i].vibrations);
  }
  EXPECT_FALSE(reader.next(read).value());
  EXPECT_FALSE(reader.next(read).value());
}

// Two paths, the first longer than what one cycle copies.
TEST(RoundTrip, EachFrameHasItsPath) {
  const test::Folder folder;
  test::Random random(2);
  std::vector<PathSegment> first;
  for (int i = 0; i < 100; ++i) {
    first.push_back(test::any_segment(random));
  }
  const std::vector<PathSegment> second = {test::any_segment(random)};
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    for (int i = 0; i < 4; ++i) {
      test::add(*writer, {}, first);
    }
    test::add(*writer, {});
    test::add(*writer, {}, second);
  }
  auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_TRUE(reader.paths_complete());
  Sample read;
  for (const kernel::signal::PathView path :
       {kernel::signal::PathView(first), kernel::signal::PathView(first),
        kernel::signal::PathView(first), kernel::signal::PathView(first),
        kernel::signal::PathView(), kernel::signal::PathView(second)}) {
    ASSERT_TRUE(reader.next(read).value());
    EXPECT_EQ(test::bits_of(read.frame.path), test::bits_of(path));
  }
}

// The text corrects both parts' paths, which have one original.
TEST(RoundTrip, EachFrameHasItsOriginal) {
  const test::Folder folder;
  test::Random random(3);
  std::vector<PathSegment> path;
  std::vector<PathSegment> original;
  for (int i = 0; i < 100; ++i) {
    path.push_back(test::any_segment(random));
    original.push_back(test::any_segment(random));
  }
  const std::vector<PathSegment> other = {test::any_segment(random)};
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    for (int i = 0; i < 8; ++i) {
      test::add(*writer, {}, i < 7 ? path : other, original);
    }
  }
  auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_TRUE(reader.paths_complete());
  Sample read;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(reader.next(read).value());
    EXPECT_EQ(test::bits_of(read.frame.path), test::bits_of(i < 7 ? path : other)) << i;
    EXPECT_EQ(test::bits_of(read.frame.original), test::bits_of(original)) << i;
  }
}

TEST(RoundTrip, APathThatWasNotCopiedToItsEndIsTold) {
  const test::Folder folder;
  const std::vector<PathSegment> path(100);
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    test::add(*writer, {}, path);
  }
  EXPECT_FALSE(RecordReader::open(folder.file("a.sqlite")).value().paths_complete());
}

TEST(RoundTrip, TheRunAndItsEventsComeBack) {
  const test::Folder folder;
  const RunInfo info = {.start_utc = "2026-11-26T12:49:34Z",
                        .machine = "mill",
                        .machine_text = std::string("a\0b", 3),
                        .program = "part.mpf",
                        .program_text = "G1 X1 ; Ø\n",
                        .listener = "{\"depth_mm\":0.30000000000000004}",
                        .cycle_s = 0.002,
                        .capability = {.feed_override = true,
                                       .path_offset = true,
                                       .path_offset_delay_s = 0.003,
                                       .path_offset_acceleration_mm_s2 = 1234567.0}};
  {
    const auto writer = RecordWriter::make({.file = folder.file("a.sqlite"), .info = info}).value();
    writer->event(EventKind::mode, "act");
    test::add(*writer, {});
    writer->event(EventKind::note, std::string(500, 'x'));
  }
  const auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_EQ(reader.run().start_utc, info.start_utc);
  EXPECT_FALSE(reader.run().version.empty());
  EXPECT_EQ(reader.run().machine_text, info.machine_text);
  EXPECT_EQ(reader.run().program_text, info.program_text);
  EXPECT_EQ(reader.run().listener, info.listener);
  EXPECT_EQ(reader.run().cycle_s, 0.002);
  EXPECT_TRUE(reader.run().capability.feed_override);
  EXPECT_FALSE(reader.run().capability.axis_offset);
  EXPECT_TRUE(reader.run().capability.path_offset);
  EXPECT_EQ(reader.run().capability.path_offset_delay_s, 0.003);
  EXPECT_EQ(reader.run().capability.path_offset_acceleration_mm_s2, 1234567.0);
  EXPECT_TRUE(reader.run().capability.latched_word);
  ASSERT_EQ(reader.events().size(), 2U);
  EXPECT_EQ(reader.events()[0].before, 0U);
  EXPECT_EQ(reader.events()[0].kind, EventKind::mode);
  EXPECT_EQ(reader.events()[0].text, "act");
  EXPECT_EQ(reader.events()[1].before, 1U);
  EXPECT_EQ(reader.events()[1].text, std::string(RecordWriter::kEventText, 'x'));
}

}  // namespace
}  // namespace steadyrest::record
