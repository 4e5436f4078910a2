// SPDX-License-Identifier: Apache-2.0
// Which samples of a record teach: made records of a straight and a bent path, disturbed on
// purpose, against what was done to them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/in_force.hpp>
#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/path_follower.hpp>
#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/contour/offline/learn/stretches.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using online::test::PathMaker;

constexpr double kRecordPeriod_s = 0.004;
constexpr double kPlanSpeed_mm_s = 20.0;

std::vector<PathSegment> bent() {
  return PathMaker({0, 0, 0}, kPlanSpeed_mm_s)
      .line_to({40, 0, 0})
      .line_to({40, 30, 0})
      .line_to({0, 30, 0})
      .path();
}

Point at(const std::vector<PathSegment>& path, double position_mm) {
  const PathSegment& segment = path[geometry::segment_at(path, position_mm)];
  return geometry::point_at(segment,
                            geometry::parameter_at(segment, position_mm - segment.position_mm));
}

double length(const std::vector<PathSegment>& path) {
  return path.back().position_mm + path.back().length_mm;
}

/// Undisturbed: the whole path at one speed.
PlannedMotion planned(const std::vector<PathSegment>& path) {
  PlannedMotion plan;
  for (double s = 0.0; s <= length(path); s += kPlanSpeed_mm_s * kRecordPeriod_s) {
    ModelSample sample;
    sample.time_s = s / kPlanSpeed_mm_s;
    sample.position_mm = s;
    sample.command_mm_s = kPlanSpeed_mm_s;
    sample.foot_mm = s;
    sample.cuts = true;
    plan.add(sample);
  }
  return plan;
}

/// A record whose command moves at speed(s, t) along the path.
PartRecord recorded(const std::vector<PathSegment>& path,
                    const std::function<double(double, double)>& speed_mm_s) {
  PartRecord record;
  record.period_s = kRecordPeriod_s;
  double s = 0.0;
  for (double t_s = 0.0; s <= length(path); t_s += kRecordPeriod_s) {
    record.time_s.push_back(t_s);
    record.command_mm.push_back(at(path, s));
    record.actual_mm.push_back(at(path, s));
    s += kRecordPeriod_s * speed_mm_s(s, t_s);
  }
  return record;
}

double constant(double /*s*/, double /*t_s*/) {
  return kPlanSpeed_mm_s;
}

std::size_t count(const Judged& judged, Use use) {
  return static_cast<std::size_t>(std::ranges::count(judged.use, use));
}

TEST(PathFollower, KnowsThePlaceOfEveryCommandOnceProved) {
  const auto path = bent();
  PathFollower follower(path, 0.02);
  for (double s = 0.0; s < length(path); s += 0.08) {
    const auto found = follower.next(at(path, s));
    if (s > PathFollower::kProof_mm + 0.3) {
      ASSERT_TRUE(found) << s;
      EXPECT_NEAR(*found, s, 0.02);
    }
  }
}

// There and back on one line, twice: the place is told by the way that led there.
TEST(PathFollower, IsNotMisledByAPathThatRunsBackOnItself) {
  const auto path = PathMaker({0, 0, 0}, kPlanSpeed_mm_s)
                        .line_to({20, 0, 0})
                        .line_to({0, 0, 0})
                        .line_to({20, 0, 0})
                        .line_to({0, 0, 0})
                        .path();
  PathFollower follower(path, 0.02);
  for (double s = 0.0; s < 80.0; s += 0.08) {
    const auto found = follower.next(at(path, s));
    if (s > 3.0) {
      ASSERT_TRUE(found) << s;
      EXPECT_NEAR(*found, s, 0.05);
    }
  }
}

TEST(PathFollower, ACommandBesideThePathHasNoPlace) {
  const auto path = bent();
  PathFollower follower(path, 0.02);
  for (double s = 0.0; s < length(path); s += 0.08) {
    const Point on = at(path, s);
    EXPECT_FALSE(follower.next({on[0], on[1], on[2] + 0.05}));
  }
}

// The tool is lifted off at 30 mm and put back at 50: the place is lost, found and proved again.
TEST(PathFollower, FindsThePathAgainAfterALift) {
  const auto path = bent();
  PathFollower follower(path, 0.02);
  const auto lost_after_mm = 50.0 + PathFollower::kProof_mm;
  const auto most_wait_mm = 512 * 0.08;  // the longest between two searches
  double found_from_mm = 0.0;
  for (double s = 0.0; s < length(path); s += 0.08) {
    Point command = at(path, s);
    const bool lifted = s > 30.0 && s < 50.0;
    command[2] += lifted ? 5.0 : 0.0;
    const auto found = follower.next(command);
    EXPECT_FALSE(lifted && found) << s;
    if (s > 50.0 && found && found_from_mm == 0.0) {
      found_from_mm = s;
    }
    if (found) {
      EXPECT_NEAR(*found, s, 0.03);
    }
  }
  EXPECT_GE(found_from_mm, lost_after_mm - 0.1);
  EXPECT_LE(found_from_mm, lost_after_mm + most_wait_mm);
}

TEST(JudgedRecord, AnUndisturbedPartTeachesThroughout) {
  const auto path = bent();
  const Judged judged = judge(recorded(path, constant), path, planned(path), {});
  EXPECT_GT(count(judged, Use::learns), judged.use.size() * 9 / 10);
  EXPECT_EQ(count(judged, Use::overridden), 0U);
  EXPECT_EQ(count(judged, Use::paused), 0U);
}

// Half the feed between 50 and 70 mm: that is left out, and nothing far from it.
TEST(JudgedRecord, AnotherFeedThanPlannedIsLeftOut) {
  const auto path = bent();
  const auto record = recorded(path, [](double s, double) {
    return s > 50.0 && s < 70.0 ? 0.5 * kPlanSpeed_mm_s : kPlanSpeed_mm_s;
  });
  const Judged judged = judge(record, path, planned(path), {});
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double s = judged.position_mm[i];
    if (s > 51.0 && s < 70.0) {
      EXPECT_EQ(judged.use[i], Use::overridden) << s;
    } else if ((s > 10.0 && s < 45.0) || s > 80.0) {
      EXPECT_EQ(judged.use[i], Use::learns) << s;
    }
  }
}

TEST(JudgedRecord, AnOverrideWithinTheShareTeaches) {
  const auto path = bent();
  const auto record = recorded(path, [](double, double) { return 0.98 * kPlanSpeed_mm_s; });
  EXPECT_EQ(count(judge(record, path, planned(path), {}), Use::overridden), 0U);
}

// One second of standing still at 60 mm, by the command and by a gap in the record.
TEST(JudgedRecord, APauseIsLeftOutWithWhatFollowsIt) {
  const auto path = bent();
  const auto standing = recorded(
      path, [](double s, double t_s) { return s >= 60.0 && t_s < 4.0 ? 0.0 : kPlanSpeed_mm_s; });
  auto gap = recorded(path, constant);
  for (std::size_t i = 0; i < gap.size(); ++i) {
    gap.time_s[i] += gap.time_s[i] > 3.0 ? 1.0 : 0.0;
  }
  const JudgeConfig config;
  for (const PartRecord& record : {standing, gap}) {
    const Judged judged = judge(record, path, planned(path), config);
    EXPECT_GT(count(judged, Use::paused), 5U);
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double s = judged.position_mm[i];
      if (s > 60.1 && s < 60.0 + 0.9 * config.settle_s * kPlanSpeed_mm_s) {
        EXPECT_EQ(judged.use[i], Use::paused) << s;
      } else if ((s > 10.0 && s < 55.0) || s > 75.0) {
        EXPECT_EQ(judged.use[i], Use::learns) << s;
      }
    }
  }
}

// The last sample comes after a gap: nothing behind it is looked at.
TEST(JudgedRecord, MayEndWithAGap) {
  const auto path = bent();
  auto record = recorded(path, constant);
  record.time_s.back() += 1.0;
  const Judged judged = judge(record, path, planned(path), {});
  EXPECT_EQ(judged.use.back(), Use::paused);
  EXPECT_EQ(judged.use[judged.use.size() / 2], Use::learns);
}

TEST(JudgedRecord, RapidsAreNoCut) {
  const auto path = PathMaker({0, 0, 0}, kPlanSpeed_mm_s)
                        .line_to({30, 0, 0})
                        .motion(kernel::signal::Motion::rapid)
                        .line_to({30, 30, 0})
                        .motion(kernel::signal::Motion::feed)
                        .line_to({0, 30, 0})
                        .path();
  const Judged judged = judge(recorded(path, constant), path, planned(path), {});
  for (std::size_t i = 0; i < judged.use.size(); ++i) {
    const double s = judged.position_mm[i];
    if (s > 30.5 && s < 59.5) {
      EXPECT_EQ(judged.use[i], Use::no_cut) << s;
    }
  }
}

TEST(JudgedRecord, AnotherProgramTeachesNothing) {
  const auto path = bent();
  const auto other = PathMaker({0, 5, 0}, kPlanSpeed_mm_s).line_to({35, 25, 0}).path();
  const Judged judged = judge(recorded(other, constant), path, planned(path), {});
  EXPECT_EQ(count(judged, Use::learns), 0U);
}

TEST(JudgedRecord, EveryUseHasItsReason) {
  for (const Use use :
       {Use::learns, Use::no_cut, Use::off_path, Use::paused, Use::overridden, Use::too_large}) {
    EXPECT_FALSE(reason_of(use).empty());
  }
}

TEST(SharpCorners, AreWhereThePathBendsAndAtItsEnds) {
  const SharpCorners corners = sharp_corners(bent());
  EXPECT_TRUE(corners.between(39.9, 40.1));
  EXPECT_FALSE(corners.between(41.0, 69.0));
  EXPECT_DOUBLE_EQ(corners.before(55.0), 40.0);
  EXPECT_DOUBLE_EQ(corners.after(55.0), 70.0);
  EXPECT_DOUBLE_EQ(corners.after(80.0), 110.0);
}

std::vector<ErrorSample> errors(double from_mm, double to_mm, const Point& off_mm) {
  std::vector<ErrorSample> out;
  for (double s = from_mm; s <= to_mm; s += kPlanSpeed_mm_s * kRecordPeriod_s) {
    out.push_back({.valid = true, .time_s = s / kPlanSpeed_mm_s, .foot_mm = s, .off_mm = off_mm});
  }
  return out;
}

// A constant error is taken away whole, right up to the corners; the other side knows nothing.
TEST(Stretches, EndAtCorners) {
  const SharpCorners corners = sharp_corners(bent());
  Learnt learnt;
  learnt.add(stretches_of(errors(1.0, 39.5, {0.0, 0.004, 0.0}), corners, {0.02, 0.02, 0.02}, 0.01));
  EXPECT_NEAR(learnt.shift_mm(0.2)[1], 0.004, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(20.0)[1], 0.004, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(39.95)[1], 0.004, 1e-12);
  EXPECT_EQ(learnt.shift_mm(40.5), Point{});
}

// Beside what was left out the shift falls to 0 within 3σ, without a step.
TEST(Stretches, FadeBesideWhatWasLeftOut) {
  const SharpCorners corners = sharp_corners(bent());
  auto samples = errors(1.0, 20.0, {0.0, 0.004, 0.0});
  const double last_mm = samples.back().foot_mm;
  samples.push_back({.valid = false, .fades = true, .time_s = 1.01, .foot_mm = 20.2});
  Learnt learnt;
  learnt.add(stretches_of(samples, corners, {0.0, 0.0, 0.0}, 0.01));
  const double fade_mm = 0.03 * kPlanSpeed_mm_s;
  EXPECT_NEAR(learnt.shift_mm(last_mm - 1.5 * fade_mm)[1], 0.004, 1e-12);
  EXPECT_NEAR(learnt.shift_mm(last_mm - 0.5 * fade_mm)[1], 0.002, 1e-4);
  EXPECT_NEAR(learnt.shift_mm(last_mm)[1], 0.0, 1e-12);
  EXPECT_EQ(learnt.shift_mm(last_mm + 1.0), Point{});
}

// An error that grows at c mm/s needs the lead g·c on top: the axis lags by that.
TEST(Stretches, LeadByTheAxisLag) {
  const SharpCorners corners({0.0, 40.0});
  auto samples = errors(1.0, 39.0, {});
  for (ErrorSample& sample : samples) {
    sample.off_mm = {0.01 * sample.time_s, 0.0, 0.0};
  }
  Learnt learnt;
  learnt.add(stretches_of(samples, corners, {0.02, 0.02, 0.02}, 0.01));
  EXPECT_NEAR(learnt.shift_mm(20.0)[0], 0.01 * (1.0 + 0.02), 1e-9);
  EXPECT_NEAR(learnt.unknown_mm(20.0)[0], 0.01, 1e-9);
}

TEST(Learnt, SeveralPartsTeachTheirMean) {
  const SharpCorners corners({0.0, 40.0});
  Learnt learnt;
  EXPECT_TRUE(learnt.empty());
  learnt.add(stretches_of(errors(1.0, 39.0, {0.002, 0, 0}), corners, {}, 0.01));
  learnt.add(stretches_of(errors(1.0, 39.0, {0.006, 0, 0}), corners, {}, 0.01));
  EXPECT_FALSE(learnt.empty());
  EXPECT_NEAR(learnt.shift_mm(20.0)[0], 0.004, 1e-12);
}

}  // namespace
}  // namespace steadyrest::contour::offline
