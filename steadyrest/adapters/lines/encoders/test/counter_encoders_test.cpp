// SPDX-License-Identifier: Apache-2.0
// Encoders on the kernel's counters: sysfs is a folder of ours, a counter's events come through a
// pipe with a name.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/counter.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/counter_encoders.hpp>

namespace steadyrest::adapters::lines {
namespace {

namespace fs = std::filesystem;

class Counters : public ::testing::Test {
 protected:
  Counters() {
    std::string name = (fs::temp_directory_path() / "counters-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    for (const auto* count : {"counter0/count0", "counter0/count1", "counter3/count0"}) {
      fs::create_directories(root_ / count);
      put(fs::path(count) / "count", "100");
      put(fs::path(count) / "function", "quadrature x4");
    }
    told() = 0;
    tells() = true;
  }
  ~Counters() override {
    if (events_ >= 0) {
      ::close(events_);
    }
    fs::remove_all(root_);
  }
  void put(const fs::path& file, const std::string& text) const {
    std::ofstream(root_ / file) << text << "\n";
  }
  static int& told() {
    static int watches = 0;
    return watches;
  }
  static bool& tells() {
    static bool yes = true;
    return yes;
  }
  static int control(int /*descriptor*/, unsigned long request, void* data) {
    if (request == COUNTER_ADD_WATCH_IOCTL) {
      const auto& watch = *static_cast<counter_watch*>(data);
      EXPECT_EQ(watch.event, COUNTER_EVENT_CHANGE_OF_STATE);
      EXPECT_EQ(watch.component.type, COUNTER_COMPONENT_COUNT);
      ++told();
      return 0;
    }
    EXPECT_EQ(request, COUNTER_ENABLE_EVENTS_IOCTL);
    return tells() ? 0 : -1;
  }
  [[nodiscard]] kernel::outcome::Result<std::unique_ptr<CounterEncoders>> open() const {
    kernel::machine::Recorder recorder;
    recorder.inputs = {0, 1, 3, 0};
    return CounterEncoders::open(recorder,
                                 {.control = control, .devices = root_ / "dev", .counters = root_});
  }
  void with_events() {
    fs::create_directories(root_ / "dev");
    const fs::path device = root_ / "dev" / "counter0";
    ASSERT_EQ(::mkfifo(device.c_str(), 0600), 0);
    events_ = ::open(device.c_str(), O_RDWR | O_NONBLOCK);
    ASSERT_GE(events_, 0);
  }
  void change(std::uint8_t count, std::uint64_t value) const {
    counter_event event{};
    event.timestamp = edge_clock_ns();
    event.value = value;
    event.watch.component.parent = count;
    ASSERT_EQ(::write(events_, &event, sizeof(event)), static_cast<ssize_t>(sizeof(event)));
  }

  fs::path root_;
  int events_ = -1;
};

TEST_F(Counters, AreReadFromWhereTheyStand) {
  const auto encoders = open().value();
  put("counter0/count1/count", "107");
  put("counter3/count0/count", "98");
  const auto now = encoders->next().value();
  EXPECT_EQ(now.counters, 2U);
  EXPECT_EQ(now.count[0], 7);
  EXPECT_EQ(now.count[1], -2);
  EXPECT_EQ(now.direction[1], -1);
  EXPECT_TRUE(std::isnan(now.edge_s[0])) << "nothing tells when";
  EXPECT_GT(encoders->next().value().time_s, now.time_s);
}

TEST_F(Counters, WrapAtTheirCeiling) {
  put("counter0/count1/ceiling", "65535");
  put("counter0/count1/count", "65530");
  const auto encoders = open().value();
  put("counter0/count1/count", "4");
  EXPECT_EQ(encoders->next().value().count[0], 10);
  put("counter0/count1/count", "65535");
  EXPECT_EQ(encoders->next().value().count[0], 5);
  put("counter0/count1/count", "30000");
  const auto jumped = encoders->next();
  ASSERT_FALSE(jumped);
  EXPECT_NE(jumped.error().what.find("jumped from 65535 to 30000"), std::string::npos);
  EXPECT_FALSE(encoders->next()) << "for good";
}

TEST_F(Counters, WrapBeyondHalfOfWhatANumberHolds) {
  put("counter0/count1/ceiling", "13835058055282163711");  // 3·2⁶² − 1
  put("counter0/count1/count", "3");
  const auto encoders = open().value();
  put("counter0/count1/count", "13835058055282163709");
  EXPECT_EQ(encoders->next().value().count[0], -6);
}

TEST_F(Counters, ACounterThatTellsOfChangesGivesTheEdgeItsTime) {
  with_events();
  const auto encoders = open().value();
  EXPECT_EQ(told(), 1) << "counter3 has no device file";
  const auto before = encoders->next().value();
  change(1, 101);
  change(1, 102);
  change(1, 101);
  put("counter0/count1/count", "101");
  const auto now = encoders->next().value();
  EXPECT_EQ(now.count[0], 1);
  EXPECT_EQ(now.direction[0], -1) << "of the last edge";
  EXPECT_GT(now.edge_s[0], before.time_s);
  EXPECT_LE(now.edge_s[0], now.time_s);
  // An event whose value is not the count's: others are missing.
  change(1, 102);
  put("counter0/count1/count", "105");
  const auto later = encoders->next().value();
  EXPECT_EQ(later.count[0], 5);
  EXPECT_TRUE(std::isnan(later.edge_s[0]));
}

TEST_F(Counters, ADriverThatDoesNotTellStillCounts) {
  with_events();
  tells() = false;
  const auto encoders = open().value();
  change(1, 103);
  put("counter0/count1/count", "103");
  const auto now = encoders->next().value();
  EXPECT_EQ(now.count[0], 3);
  EXPECT_TRUE(std::isnan(now.edge_s[0]));
}

TEST_F(Counters, WhatCannotBeAPositionIsRefusedByName) {
  put("counter3/count0/function", "increase");
  EXPECT_NE(open().error().what.find("counter3/count0 counts one way only"), std::string::npos);
  put("counter3/count0/function", "quadrature x4");
  put("counter3/count0/enable", "0");
  EXPECT_NE(open().error().what.find("counter3/count0 is switched off"), std::string::npos);
  put("counter3/count0/enable", "1");
  put("counter3/count0/ceiling", "0");  // as some begin: it would stay at 0 for ever
  EXPECT_NE(open().error().what.find("counter3/count0 counts up to 0 only"), std::string::npos);
  put("counter3/count0/ceiling", "65535");
  put("counter3/count0/count", "none");
  EXPECT_NE(open().error().what.find("counter3/count0 cannot be read"), std::string::npos);
  fs::remove_all(root_ / "counter3");
  EXPECT_NE(open().error().what.find("counter3/count0 cannot be opened"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::adapters::lines
