// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/apps/page/motion/estimate_page.hpp>

namespace steadyrest::apps::page {
namespace {

motion::online::Estimate at(double t_s, double velocity_mm_s, double bound_mm_s) {
  motion::online::Estimate out;
  out.t_s = t_s;
  out.velocity_mm_s = velocity_mm_s;
  out.velocity_bound_mm_s = bound_mm_s;
  return out;
}

/// As the page finds it.
Json page_of(const EstimateCourse& course) {
  return Json::parse(text_of(
      estimate_page({{"ticks", 1}}, {.log = "axis </script>.csv", .count_mm = 0.001}, course)));
}

// Up to the limit each tick has its own stretch. NaN bounds become null.
TEST(EstimatePage, OfAShortLogHasEveryTick) {
  EstimateCourse course(4);
  for (int i = 0; i < 4; ++i) {
    course.add(at(i, 10.0 * i, 0.5));
  }
  const Json page = page_of(course);
  EXPECT_EQ(page["schema"], "steadyrest-motion/1");
  EXPECT_EQ(page["ticks_each"], 1);
  EXPECT_EQ(page["t_s"], Json({0.0, 1.0, 2.0, 3.0}));
  EXPECT_EQ(page["velocity_mm_s"]["low"], Json({0.0, 10.0, 20.0, 30.0}));
  EXPECT_EQ(page["velocity_mm_s"]["high"], page["velocity_mm_s"]["low"]);
  EXPECT_EQ(page["velocity_mm_s"]["bound"], Json({0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(page["acceleration_mm_s2"]["bound"], Json({nullptr, nullptr, nullptr, nullptr}));
}

// Odd and even limits and lengths around powers of two, where joining in pairs goes wrong first. A
// dip of −70 and a bound of 9 in one tick each must survive.
TEST(EstimatePage, OfALongLogLosesNoPeakAndNoBound) {
  for (const std::size_t most : {2U, 3U, 64U}) {
    for (const int ticks : {5, 64, 65, 1000, 1001}) {
      EstimateCourse course(most);
      for (int i = 0; i < ticks; ++i) {
        course.add(at(i, i == ticks / 3 ? -70.0 : std::sin(i), i == ticks / 2 ? 9.0 : 0.5));
      }
      const Json page = page_of(course);
      const auto stretches = page["t_s"].size();
      EXPECT_LE(stretches, most);
      EXPECT_GE(stretches * course.ticks_each(), static_cast<std::size_t>(ticks));
      EXPECT_LT((stretches - 1) * course.ticks_each(), static_cast<std::size_t>(ticks));
      double low = 0.0;
      double bound = 0.0;
      for (std::size_t k = 0; k < stretches; ++k) {
        low = std::min(low, page["velocity_mm_s"]["low"][k].get<double>());
        bound = std::max(bound, page["velocity_mm_s"]["bound"][k].get<double>());
        EXPECT_EQ(page["t_s"][k], static_cast<double>(k * course.ticks_each()));
      }
      EXPECT_EQ(low, -70.0);
      EXPECT_EQ(bound, 9.0);
    }
  }
}

}  // namespace
}  // namespace steadyrest::apps::page
