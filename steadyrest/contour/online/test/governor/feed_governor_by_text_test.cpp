// SPDX-License-Identifier: Apache-2.0
// A program whose text corrects the path: the layer leaves it alone, and judges it by the original.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;
using test::ClosedLoop;
using test::kTurn;
using test::LoopSample;
using test::PathMaker;
using test::PathSegment;

constexpr double kTextRadius_mm = 10.0;
constexpr double kTextGain_1_s = 50.0;
constexpr double kTextFeed_mm_s = 4000.0 / 60.0;

/// The axes lag on a circle of this radius so that the tool comes out on that of kTextRadius_mm.
double commanded_radius_mm() {
  const double q = kTextFeed_mm_s / (kTextRadius_mm * kTextGain_1_s);
  return kTextRadius_mm * std::sqrt(1.0 + q * q);
}

/// A circle, then a straight line, then another circle of this radius, all at one feed.
std::vector<PathSegment> two_circles(double second_radius_mm) {
  PathMaker path({kTextRadius_mm, 0, 0}, kTextFeed_mm_s);
  path.arc({0, 0, 0}, 3 * kTurn).line_to({second_radius_mm, 100, 0});
  path.arc({0, 100, 0}, 4 * kTurn);
  return path.limited(1000.0, 10.0);
}

struct Corrected {
  Corrected() {
    for (std::size_t i = 0; i < path.size(); ++i) {
      path[i].original_start_mm = original[i].position_mm;
      path[i].original_end_mm = original[i].position_mm + original[i].length_mm;
    }
    path.back().by_text = true;
    // At the joint both paths are the same; the feed along the larger circle is larger.
    path.back().feed_mm_s *= commanded_radius_mm() / kTextRadius_mm;
  }
  std::vector<PathSegment> original = two_circles(kTextRadius_mm);
  std::vector<PathSegment> path = two_circles(commanded_radius_mm());
};

/// The samples with the command in the corrected circle.
std::vector<LoopSample> within_text(const Corrected& part, const std::vector<LoopSample>& all) {
  std::vector<LoopSample> samples;
  std::ranges::copy_if(all, std::back_inserter(samples), [&part](const LoopSample& sample) {
    return sample.position_mm >= part.path.back().position_mm;
  });
  return samples;
}

TEST(FeedGovernorByText, FallsWhereTheTextIsTheOriginalAndIsBackBeforeItCorrects) {
  const Corrected part;
  ClosedLoop loop(test::mill(kTextGain_1_s), part.path);
  loop.disturb = [&part](Frame& frame) { frame.original = part.original; };
  const auto all = loop.run(0.010).sample;
  const auto on_first = std::ranges::find_if(
      all, [](const LoopSample& sample) { return sample.position_mm > 100.0; });
  EXPECT_DOUBLE_EQ(on_first->effective, 0.30);
  const auto samples = within_text(part, all);
  ASSERT_GT(samples.size(), 1000U);
  for (const LoopSample& sample : samples) {
    ASSERT_DOUBLE_EQ(sample.effective, 1.0) << sample.position_mm;
    ASSERT_FALSE(sample.output.decided) << sample.position_mm;
  }
}

TEST(FeedGovernorByText, ShowsTheErrorAgainstTheOriginal) {
  const Corrected part;
  ClosedLoop loop(test::mill(kTextGain_1_s), part.path);
  loop.disturb = [&part](Frame& frame) { frame.original = part.original; };
  const auto samples = within_text(part, loop.run(0.010).sample);
  const LoopSample& settled = samples[samples.size() / 2];
  EXPECT_TRUE(settled.output.error_valid);
  EXPECT_EQ(settled.output.request.reason, Reason::contour_in_text);
  // Against its own path the tool is R′ − R inside.
  EXPECT_NEAR(settled.error_mm, commanded_radius_mm() - kTextRadius_mm, 0.0005);
  EXPECT_NEAR(settled.output.error_mm, 0.0, 0.0005);
}

// The same program without a word of its text: what the layer did before.
TEST(FeedGovernorByText, WithoutTheMarksTheSameProgramIsSpoilt) {
  Corrected part;
  part.path.back().by_text = false;
  ClosedLoop loop(test::mill(kTextGain_1_s), part.path);
  const auto samples = within_text(part, loop.run(0.010).sample);
  EXPECT_LT(samples[samples.size() / 2].effective, 0.5);
}

TEST(FeedGovernorByText, AnUnknownOriginalHasNoErrorAndNoWish) {
  const Corrected part;
  ClosedLoop loop(test::mill(kTextGain_1_s), part.path);
  loop.disturb = [](Frame& frame) { frame.original_unknown = true; };
  for (const LoopSample& sample : loop.run(0.010).sample) {
    ASSERT_DOUBLE_EQ(sample.requested, 1.0);
    ASSERT_FALSE(sample.output.error_valid);
    ASSERT_EQ(sample.output.request.reason, Reason::contour_original_unknown);
  }
}

// Where the place on the path is lost, the original is unknown and must not be guessed.
TEST(FeedGovernorByText, AnUnknownOriginalWithoutAPathIsLeftAloneToo) {
  const Corrected part;
  ClosedLoop loop(test::mill(kTextGain_1_s), part.path);
  loop.show_path = false;
  loop.disturb = [](Frame& frame) { frame.original_unknown = true; };
  for (const LoopSample& sample : loop.run(0.010, 0.0, 2.0).sample) {
    ASSERT_DOUBLE_EQ(sample.requested, 1.0);
  }
}

TEST(FeedGovernorByText, OffsetsStayOutOfWhatTheTextCorrects) {
  const Corrected part;
  auto machine = test::mill(kTextGain_1_s);
  machine.envelope.max_path_offset_mm = 0.5;
  ClosedLoop loop(machine, part.path);
  loop.offsets_act = true;
  loop.disturb = [&part](Frame& frame) { frame.original = part.original; };
  const auto all = loop.run(0.010).sample;
  const auto largest = [](const auto& samples) {
    double most = 0.0;
    for (const LoopSample& sample : samples) {
      for (const double offset : sample.output.path_offset.offset_mm) {
        most = std::max(most, std::abs(offset));
      }
    }
    return most;
  };
  EXPECT_GT(largest(all), 0.05);
  EXPECT_EQ(largest(within_text(part, all)), 0.0);
}

}  // namespace
}  // namespace steadyrest::contour::online
