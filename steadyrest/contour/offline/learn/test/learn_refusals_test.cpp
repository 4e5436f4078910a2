// SPDX-License-Identifier: Apache-2.0
// What cannot teach is refused before anything is learnt, with the reason and the remedy.
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/learn.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;
using online::test::PathMaker;

nc::plan::PlannedPath straight(const Point& end) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, 20.0).line_to(end).path();
  path.segments.front().line = 7;
  path.plans.resize(1);
  return path;
}

struct Attempt {
  nc::plan::PlannedPath original = straight({100, 0, 0});
  nc::plan::PlannedPath cut = straight({100, 0, 0});
  double period_s = 0.004;
  LearnConfig config = {};
};

/// The refusal; empty where it learns. Nothing may have been learnt.
std::string refusal_of(const Attempt& attempt) {
  const kernel::machine::Machine machine;
  PartRecord record;
  record.file = "part.csv";
  record.period_s = attempt.period_s;
  Learnt learnt;
  const Lesson lesson{.machine = machine,
                      .original = attempt.original,
                      .cut = attempt.cut,
                      .record = record,
                      .model = {}};
  const auto figures = learn(lesson, attempt.config, learnt);
  EXPECT_TRUE(learnt.empty());
  return figures ? "" : kernel::outcome::text(figures.error());
}

TEST(LearnRefuses, ACutOffThatDoesNotConverge) {
  Attempt attempt;
  attempt.config.cut_off_hz = 500.0;
  const std::string said = refusal_of(attempt);
  EXPECT_NE(said.find("500.0 Hz"), std::string::npos) << said;
  EXPECT_NE(said.find("lower cut-off"), std::string::npos) << said;
}

// Two samples in the time constant 1/k of the default gain, 50 1/s, are 100 a second.
TEST(LearnRefuses, ARecordThatIsTooSlow) {
  const std::string said = refusal_of({.period_s = 0.02});
  EXPECT_NE(said.find("part.csv"), std::string::npos) << said;
  EXPECT_NE(said.find("50 samples a second"), std::string::npos) << said;
  EXPECT_NE(said.find("100"), std::string::npos) << said;
}

TEST(LearnRefuses, AProgramOfAnotherPart) {
  const std::string said = refusal_of({.cut = straight({100, 40, 0})});
  EXPECT_NE(said.find("leaves the original"), std::string::npos) << said;
  EXPECT_NE(said.find("line 7"), std::string::npos) << said;
}

}  // namespace
}  // namespace steadyrest::contour::offline
