// SPDX-License-Identifier: Apache-2.0
// Encoders on GPIO lines: the chip's calls are ours, its edges come through a pipe.
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/gpio_encoders.hpp>

namespace steadyrest::adapters::lines {
namespace {

constexpr std::array<std::uint32_t, 4> kInputs = {17, 27, 5, 6};

/// What the chip is asked, and what it answers.
struct Chip {
  Chip() {
    EXPECT_EQ(::pipe(pipe.data()), 0);
    EXPECT_EQ(::fcntl(pipe[1], F_SETFL, O_NONBLOCK), 0);
    now() = this;
  }
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;
  ~Chip() {
    ::close(pipe[1]);
    if (!given) {
      ::close(pipe[0]);
    }
  }
  static Chip*& now() {
    static Chip* chip = nullptr;
    return chip;
  }
  static int control(int /*descriptor*/, unsigned long request, void* data) {
    Chip& chip = *now();
    if (request == GPIO_V2_GET_LINE_IOCTL) {
      chip.asked = *static_cast<gpio_v2_line_request*>(data);
      if (chip.busy) {
        errno = EBUSY;
        return -1;
      }
      static_cast<gpio_v2_line_request*>(data)->fd = chip.pipe[0];
      chip.given = true;
      return 0;
    }
    EXPECT_EQ(request, GPIO_V2_LINE_GET_VALUES_IOCTL);
    static_cast<gpio_v2_line_values*>(data)->bits = chip.levels;
    if (chip.restless) {
      chip.edge(17, chip.sequence % 2 == 0);
    }
    return 0;
  }
  void edge(std::uint32_t line, bool high, std::uint64_t at_ns = edge_clock_ns()) {
    gpio_v2_line_event event{};
    event.timestamp_ns = at_ns;
    event.id = high ? GPIO_V2_LINE_EVENT_RISING_EDGE : GPIO_V2_LINE_EVENT_FALLING_EDGE;
    event.offset = line;
    event.seqno = ++sequence;
    EXPECT_EQ(::write(pipe[1], &event, sizeof(event)), static_cast<ssize_t>(sizeof(event)));
  }
  /// One count further in the sequence of an encoder's channels (Gray code: 00 10 11 01).
  void turn(std::size_t encoder, int way) {
    int& phase = phases.at(encoder);
    const auto level = [](int at, bool a) { return a ? at == 1 || at == 2 : at == 2 || at == 3; };
    const int next = (phase + way + 4) % 4;
    const bool a_changes = level(phase, true) != level(next, true);
    edge(kInputs.at(2 * encoder + (a_changes ? 0 : 1)), level(next, a_changes));
    phase = next;
  }

  std::array<int, 2> pipe{};
  bool given = false;
  bool busy = false;
  bool restless = false;
  std::uint64_t levels = 0;
  std::uint32_t sequence = 0;
  std::array<int, 2> phases{};
  gpio_v2_line_request asked{};
};

kernel::outcome::Result<std::unique_ptr<GpioEncoders>> open_of(const std::string& chip) {
  kernel::machine::Recorder recorder;
  recorder.device = chip;
  recorder.inputs = {kInputs.begin(), kInputs.end()};
  return GpioEncoders::open(recorder, {.control = Chip::control});
}

TEST(GpioEncoders, AsksForBothEdgesOfEveryLineAndARoomyQueue) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  EXPECT_EQ(chip.asked.num_lines, 4U);
  EXPECT_EQ(chip.asked.offsets[1], 27U);
  EXPECT_EQ(chip.asked.event_buffer_size, 1024U);
  EXPECT_EQ(chip.asked.config.flags, GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING |
                                         GPIO_V2_LINE_FLAG_EDGE_FALLING);
  EXPECT_STREQ(chip.asked.consumer, "steadyrest encoders");
}

TEST(GpioEncoders, CountAsTheEncodersTurn) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  std::mt19937 random(4);
  std::array<std::int64_t, 2> count{};
  for (int reading = 0; reading < 200; ++reading) {
    for (int i = 0; i < 50; ++i) {
      const std::size_t of = random() % 2;
      const int way = random() % 2 == 0 ? 1 : -1;
      chip.turn(of, way);
      count.at(of) += way;
    }
    const auto now = encoders->next();
    ASSERT_TRUE(now) << kernel::outcome::text(now.error());
    ASSERT_EQ(now->counters, 2U);
    ASSERT_EQ(now->count[0], count[0]);
    ASSERT_EQ(now->count[1], count[1]);
  }
}

TEST(GpioEncoders, GiveTheLastEdgeItsTimeAndDirection) {
  Chip chip;
  chip.levels = 0b0011;  // both channels of encoder 1 are high
  chip.phases[0] = 2;
  const auto encoders = open_of("/dev/null").value();
  const auto still = encoders->next().value();
  EXPECT_TRUE(std::isnan(still.edge_s[0]));
  chip.turn(0, 1);
  chip.turn(0, -1);
  const auto after = encoders->next().value();
  EXPECT_EQ(after.count[0], 0);
  EXPECT_EQ(after.direction[0], -1);
  EXPECT_GT(after.edge_s[0], still.time_s);
  EXPECT_LE(after.edge_s[0], after.time_s);
}

TEST(GpioEncoders, AnEdgeLaterThanTheReadingBelongsToTheNext) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  const std::uint64_t at_ns = edge_clock_ns() + 500'000'000;
  chip.edge(17, true, at_ns);
  const auto first = encoders->next().value();
  while (edge_clock_ns() <= at_ns) {
    ::usleep(10'000);
  }
  const auto second = encoders->next().value();
  EXPECT_EQ(second.count[0], 1);
  // A busy computer may take the first reading only after the edge.
  EXPECT_EQ(first.count[0], first.time_s >= second.edge_s[0] ? 1 : 0);
}

TEST(GpioEncoders, LostEdgesEndThePositionsForGood) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  chip.turn(0, 1);
  ++chip.sequence;  // the kernel's queue was full
  chip.turn(1, 1);
  const auto lost = encoders->next();
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_NE(lost.error().what.find("faster than the layer reads"), std::string::npos);
  EXPECT_EQ(encoders->next().error().what, lost.error().what);
}

TEST(GpioEncoders, ALevelTwiceMeansThatAnEdgeIsMissing) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  chip.edge(5, true);
  chip.edge(5, true);
  EXPECT_EQ(encoders->next().error().what,
            "encoder 2 moved too fast for its lines: counts are lost");
}

TEST(GpioEncoders, BeginsOnlyWhenTheEncodersStand) {
  Chip chip;
  chip.edge(17, true);
  chip.edge(17, false);
  const auto encoders = open_of("/dev/null").value();
  chip.turn(0, 1);
  EXPECT_EQ(encoders->next().value().count[0], 1) << "edges before the start do not count";
}

TEST(GpioEncoders, EncodersThatMoveAtTheStartAreRefused) {
  Chip chip;
  chip.restless = true;
  const auto moving = open_of("/dev/null");
  ASSERT_FALSE(moving);
  EXPECT_EQ(moving.error().what, "the encoders move while the layer starts");
}

TEST(GpioEncoders, WhatTheChipLacksIsNamed) {
  Chip chip;
  EXPECT_EQ(open_of("/dev/no-such-chip").error().what,
            "the GPIO chip /dev/no-such-chip cannot be opened: No such file or directory");
  chip.busy = true;
  EXPECT_EQ(open_of("/dev/null").error().what,
            "the encoders' lines 17, 27, 5, 6 cannot be taken from /dev/null: Device or resource "
            "busy");
}

TEST(GpioEncoders, AChipThatGoesAwayIsAFault) {
  Chip chip;
  const auto encoders = open_of("/dev/null").value();
  ::close(chip.pipe[1]);
  EXPECT_FALSE(encoders->next());
  chip.pipe[1] = -1;
}

}  // namespace
}  // namespace steadyrest::adapters::lines
