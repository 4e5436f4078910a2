// SPDX-License-Identifier: Apache-2.0
// What a line says and does apart from its moves: events, and words whose values alone may change.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/rewrite/tube/same_line.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Event;
using interpret::EventKind;
using ::testing::HasSubstr;

constexpr Permitted kFeedsAlone{.feeds = true};
constexpr Permitted kSpeedsAlone{.speeds = true, .least_rev_s = 5.0, .most_rev_s = 100.0};

/// A line of a program, split into words.
struct LineOfWords {
  explicit LineOfWords(std::string line) : text(std::move(line)) {
    read::Reader reader(read::Dialect::linuxcnc);
    EXPECT_TRUE(reader.read(text, 1, 1, block)) << text;
  }
  std::string text;
  read::Block block;
};

TEST(SameEvents, AreTheSameButForTheSpeed) {
  const std::vector<Event> original = {{.kind = EventKind::spindle, .value = 50.0},
                                       {.kind = EventKind::coolant, .value = 2.0}};
  const auto fault = [&](std::size_t at, Event event, const Permitted& permitted) {
    auto changed = original;
    changed[at] = event;
    return event_difference(original, changed, permitted);
  };
  const Event faster{.kind = EventKind::spindle, .value = 99.0};
  EXPECT_EQ(fault(0, faster, kSpeedsAlone), "");
  EXPECT_THAT(fault(0, faster, kFeedsAlone), HasSubstr("5940 rpm in place of 3000"));
  EXPECT_THAT(fault(0, {.kind = EventKind::spindle, .value = 101.0}, kSpeedsAlone),
              HasSubstr("the machine allows 300 to 6000 rpm"));
  EXPECT_NE(fault(0, {.kind = EventKind::spindle, .value = -50.0}, kSpeedsAlone), "") << "M4";
  EXPECT_NE(fault(0, {.kind = EventKind::spindle, .value = 0.0}, kSpeedsAlone), "") << "M5";
  EXPECT_NE(fault(1, {.kind = EventKind::coolant, .value = 1.0}, kSpeedsAlone), "");
  EXPECT_NE(fault(1, {.kind = EventKind::stop, .value = 2.0}, kSpeedsAlone), "");
  EXPECT_THAT(event_difference(original, std::span(original).first(1), kSpeedsAlone),
              HasSubstr("does more or less"));
}

TEST(SameWords, DifferInSAndFAlone) {
  const auto alike = [](const char* a, const char* b) {
    return differs_in_values_alone(LineOfWords(a).block, LineOfWords(b).block);
  };
  EXPECT_TRUE(alike("N5 G1 X5 F100 S3000", "N5 G1 X5 F110 S3300"));
  EXPECT_TRUE(alike("G1 X5", "G1 X5 F90"));
  EXPECT_TRUE(alike("S3000 M3 (on)", "F7 S3300 M3"));
  EXPECT_FALSE(alike("S3000 M3", "S3300 M4"));
  EXPECT_FALSE(alike("S3000 M3", "S3300 M3 M8"));
  EXPECT_FALSE(alike("S3000 M3", "M3"));
  EXPECT_FALSE(alike("M3", "S3000 M3"));
  EXPECT_FALSE(alike("G1 X5 F100", "G1 X5.0 F100")) << "written otherwise";
  EXPECT_FALSE(alike("/S3000", "S3300"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
