// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/serial_recorder.hpp>

namespace steadyrest::adapters::lines {
namespace {

/// A serial line with the test as the recorder at its other end.
struct Line {
  Line() {
    int other = -1;
    std::array<char, 128> path{};
    EXPECT_EQ(::openpty(&recorder, &other, path.data(), nullptr, nullptr), 0);
    name = path.data();
    kept = other;
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line() {
    ::close(kept);
    ::close(recorder);
  }
  void send(std::uint16_t sequence, std::int32_t count, bool lost = false) const {
    RecorderSample sample{
        .sequence = sequence, .ticks = 1000U * sequence, .clock_hz = 1'000'000, .counters = 1};
    sample.counter[0].count = count;
    sample.counter[0].lost = lost;
    const auto bytes = message_of(sample);
    ASSERT_EQ(::write(recorder, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  [[nodiscard]] std::unique_ptr<SerialRecorder> open(double patience_s = 20.0) const {
    kernel::machine::Recorder config;
    config.device = name;
    config.baud = 115200;
    return SerialRecorder::open(config, patience_s).value();
  }

  int recorder = -1;
  int kept = -1;
  std::string name;
};

TEST(SerialRecorder, GivesTheNewestOfWhatHasCome) {
  const Line line;
  const auto recorder = line.open();
  line.send(0, 10);
  ASSERT_EQ(recorder->next().value().count[0], 0) << "counts from the first sample";
  for (std::uint16_t i = 1; i <= 5; ++i) {
    line.send(i, 10 + 100 * i);
  }
  const auto newest = recorder->next().value();
  EXPECT_EQ(newest.count[0], 500);
  EXPECT_DOUBLE_EQ(newest.time_s, 0.005);
  EXPECT_EQ(recorder->counts().missing, 0U);
}

TEST(SerialRecorder, CountsThatWereLostBetweenTwoReadingsEndThePositions) {
  const Line line;
  const auto recorder = line.open();
  line.send(0, 10);
  ASSERT_TRUE(recorder->next());
  line.send(1, 20);
  line.send(2, 30, true);
  line.send(3, 40);
  const auto refused = recorder->next();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "encoder 1 moved too fast for the recorder: counts are lost");
}

TEST(SerialRecorder, BytesAreLeftAsTheyAre) {
  const Line line;
  const auto recorder = line.open();
  line.send(0, 0);
  ASSERT_TRUE(recorder->next());
  // Those that a terminal would change: end of line, end of file, interrupt, flow control.
  line.send(1, 0x0D0A0411);
  EXPECT_EQ(recorder->next().value().count[0], 0x0D0A0411);
  line.send(2, 0x03131A0D);
  EXPECT_EQ(recorder->next().value().count[0], 0x03131A0D);
}

TEST(SerialRecorder, SaysThatNothingComesAndWhatDid) {
  const Line line;
  const auto recorder = line.open(0.01);
  const std::string noise("no message\0", 11);
  ASSERT_EQ(::write(line.recorder, noise.data(), noise.size()), 11);
  const auto none = recorder->next();
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(none.error().what,
            "the recorder " + line.name + " sends nothing (1 messages so far, 1 of them broken)");
}

TEST(SerialRecorder, ADeviceThatIsNoneIsNamed) {
  kernel::machine::Recorder config;
  config.device = "/dev/no-such-recorder";
  const auto none = SerialRecorder::open(config, 1.0);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().what,
            "the recorder /dev/no-such-recorder cannot be opened: No such file or directory");
  config.baud = 12345;
  EXPECT_FALSE(SerialRecorder::open(config, 1.0));
}

}  // namespace
}  // namespace steadyrest::adapters::lines
