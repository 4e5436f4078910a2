// SPDX-License-Identifier: Apache-2.0
#include "contour_line.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

// R = 10 mm, Kv = 3 (m/min)/mm = 50 1/s, 10 µm: v = k·R·√((R/(R−ε))² − 1) = 1343 mm/min.
TEST(ContourLimit, GivesTheFeedForAnError) {
  const Finished finished = run_line(kLimit + "--max-error-mm 0.010 --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, IsEmpty());
  const json answer = json::parse(finished.out);
  EXPECT_NEAR(answer["feed_mm_min"], 1343.0, 0.6);  // published to four digits
  EXPECT_NEAR(answer["contour_error_mm"], 0.010, 1e-9);
  EXPECT_TRUE(answer.contains("tracking_error_mm"));
}

// ε = R(1 − 1/√(1 + q²)) and Ed = R·q/√(1 + q²) with q = v/(R·k) = 0.1333.
TEST(ContourLimit, GivesTheErrorsAtAFeed) {
  const Finished finished = run_line(kLimit + "--feed-mm-min 4000 --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const json answer = json::parse(finished.out);
  EXPECT_NEAR(answer["contour_error_mm"], 0.0877, 6e-5);
  EXPECT_NEAR(answer["tracking_error_mm"], 1.3216, 6e-5);
  EXPECT_EQ(answer["feed_mm_min"], 4000.0);
}

TEST(ContourLimit, JudgesAFeedByALimit) {
  const Finished finished = run_line(kLimit + "--feed-mm-min 4000 --max-error-mm 0.01 --json");
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["within_limit"], false);
  EXPECT_NEAR(answer["limit_feed_mm_min"], 1343.0, 0.6);
}

// a = 0.5 leaves about (1 − a²), τ = 5 ms about (1 − 2kτ) of the error; the figures are simulated.
TEST(ContourLimit, TakesFeedForwardAndLag) {
  const Finished forward = run_line(kLimit + "--feed-mm-min 4000 --feed-forward 0.5 --json");
  EXPECT_NEAR(json::parse(forward.out)["contour_error_mm"], 0.0656, 1.5e-4);
  const Finished lag = run_line(kLimit + "--feed-mm-min 4000 --velocity-lag-ms 5 --json");
  EXPECT_NEAR(json::parse(lag.out)["contour_error_mm"], 0.0443, 1.5e-4);
}

// Full feed-forward without lag: no feed reaches the limit.
TEST(ContourLimit, HasNoFeedWhereNothingLimitsIt) {
  const Finished finished = run_line(kLimit + "--max-error-mm 0.01 --feed-forward 1 --json");
  EXPECT_EQ(finished.code, 0);
  EXPECT_TRUE(json::parse(finished.out)["feed_mm_min"].is_null());
}

TEST(ContourLimit, ShowsAShortTableToPeople) {
  const Finished finished = run_line(kLimit + "--feed-mm-min 4000");
  EXPECT_THAT(finished.out, HasSubstr("contour error       0.0877 mm\n"));
}

TEST(ContourLimit, RefusesWhatIsNoCircle) {
  expect_all_refused({"contour limit --radius-mm -1 --kv-1-s 50 --max-error-mm 0.01",
                      "contour limit --radius-mm nan --kv-1-s 50 --max-error-mm 0.01",
                      "contour limit --radius-mm 10 --kv-1-s 0 --max-error-mm 0.01",
                      "contour limit --radius-mm 10 --kv-1-s inf --max-error-mm 0.01",
                      "contour limit --radius-mm 10 --kv-1-s 50 --max-error-mm 10",
                      "contour limit --radius-mm 10 --kv-1-s 50 --max-error-mm 9.9999999999",
                      "contour limit --radius-mm 10 --kv-1-s 50 --feed-mm-min -5",
                      "contour limit --radius-mm 10 --kv-1-s 50"});
}

}  // namespace
}  // namespace steadyrest::test
