// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/apps/page/motion/bench_page.hpp>

namespace steadyrest::apps::page {
namespace {

using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// One scene and two estimators keep the test short; the note with </script> tests the escaping.
const PageData& sample() {
  static const PageData data = [] {
    motion::offline::BenchConfig config;
    config.scenes = {"flywheel"};
    config.estimators = {"kalman", "difference"};
    config.repetitions = 1;
    auto benchmark = motion::offline::run_benchmark(config).value();
    benchmark.notes.emplace_back("</script><b>");
    return page_data(std::move(benchmark), {}).value();
  }();
  return data;
}

TEST(BenchPage, JsonSaysWhatWasMeasured) {
  const auto json = nlohmann::json::parse(text_of(to_page(sample())));
  EXPECT_EQ(json["schema"], "steadyrest-motion-bench/1");
  // Kalman with and without the axis's limits, and differences, which know no limits.
  ASSERT_EQ(json["rows"].size(), 3U);
  EXPECT_EQ(json["rows"][1]["limits"], true);
  EXPECT_EQ(json["rows"][0]["velocity"]["rms"], sample().benchmark.rows[0].velocity.rms);
  EXPECT_EQ(json["rows"][2]["velocity"]["rms_at_lag"].size(), json["lags_s"].size());
  // Differences have no efficiency: there is no bound to compare with.
  EXPECT_TRUE(json["rows"][2]["velocity"]["efficiency"].is_null());
}

TEST(BenchPage, ColumnsOfATraceAreEquallyLong) {
  const auto json = nlohmann::json::parse(text_of(to_page(sample())));
  ASSERT_EQ(json["traces"].size(), 2U);
  for (const auto& trace : json["traces"]) {
    for (const auto& [key, column] : trace.items()) {
      EXPECT_TRUE(key == "name" || column.size() == trace["t_s"].size()) << key;
    }
  }
}

// Counts are whole, so their second differences are whole: a resolution of 1 count/tick² = 1000
// mm/s² at 1 µm and 1 kHz, against an acceleration of 6 mm/s².
TEST(BenchPage, TheFlywheelByDifferencesIsWhatTheSourceShows) {
  // Fig. 2 of the source: second differences of counts are −1, 0 or +1 counts/tick² (of 1000 mm/s²)
  // where the flywheel has −0.006.
  const Trace made = trace("flywheel").value();
  for (std::size_t k = 3; k < made.t_s.size(); ++k) {
    const double a = made.difference_acceleration_mm_s2[k] / 1000.0;
    EXPECT_NEAR(a, std::round(a), 1e-9);
    EXPECT_LE(std::abs(a), 1.0 + 1e-9);
  }
}

TEST(BenchPage, RefusesASceneThatIsNone) {
  EXPECT_FALSE(trace("no-scene").has_value());
}

TEST(BenchPage, NoTextLeavesTheScriptElement) {
  const std::string html = to_html(text_of(to_page(sample())));
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_THAT(html, EndsWith("</html>\n"));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>\\u003cb>"));
  EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("@STEADYREST_REPORT_DATA@")));
}

}  // namespace
}  // namespace steadyrest::apps::page
