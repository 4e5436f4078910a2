// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/cli/shared/progress.hpp>

namespace steadyrest::apps::cli {
namespace {

using namespace std::chrono_literals;

/// A progress bar that draws into a file, at instants of the test's choice: no sleeping.
class Drawn {
 public:
  explicit Drawn(bool terminal) : progress_(file_.get(), terminal, start_) {}

  void update(std::chrono::milliseconds after, double share) {
    progress_.update_at(start_ + after, share, "cutting");
  }
  void tick(std::chrono::milliseconds after) { progress_.tick_at(start_ + after); }
  void clear() { progress_.clear(); }
  [[nodiscard]] std::string text() {
    std::string out(static_cast<std::size_t>(std::ftell(file_.get())), '\0');
    std::rewind(file_.get());
    const std::size_t read = std::fread(out.data(), 1, out.size(), file_.get());
    out.resize(read);
    return out;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_{std::tmpfile()};  // outlives the bar, which cleans up
  Progress::Clock::time_point start_ = Progress::Clock::now();
  Progress progress_;
};

TEST(Progress, IsSilentForTheFirstSecond) {
  Drawn drawn(true);
  drawn.update(10ms, 0.1);
  drawn.update(999ms, 0.9);
  EXPECT_EQ(drawn.text(), "");
}

TEST(Progress, ShowsTheShareAndLeavesNothingBehind) {
  Drawn drawn(true);
  drawn.update(1500ms, 0.5);
  drawn.clear();
  const std::string text = drawn.text();
  EXPECT_THAT(text, testing::HasSubstr(" 50 %  cutting"));
  EXPECT_TRUE(text.ends_with("\r\x1b[K"));
}

// A thousand calls within a second.
TEST(Progress, DrawsAtMostTenTimesASecond) {
  Drawn drawn(true);
  for (int i = 0; i < 1000; ++i) {
    drawn.update(1500ms + std::chrono::milliseconds(i), 0.001 * i);
  }
  const std::string text = drawn.text();
  EXPECT_LE(std::count(text.begin(), text.end(), '%'), 10);
  EXPECT_GE(std::count(text.begin(), text.end(), '%'), 9);
}

// The seconds go on without calls, but only once the first second is over.
TEST(Progress, CountsTheSecondsOfWorkThatMakesNoCall) {
  Drawn drawn(true);
  drawn.tick(900ms);
  EXPECT_EQ(drawn.text(), "");
  drawn.tick(2000ms);
  EXPECT_THAT(drawn.text(), testing::HasSubstr("  0 %  working, 2 s"));
  drawn.update(2500ms, 0.5);
  drawn.tick(3100ms);
  EXPECT_THAT(drawn.text(), testing::EndsWith(" 50 %  cutting, 2 s"));
  drawn.tick(4000ms);
  EXPECT_THAT(drawn.text(), testing::EndsWith(" 50 %  cutting, 4 s"));
  drawn.clear();
  drawn.tick(9000ms);
  EXPECT_TRUE(drawn.text().ends_with("\r\x1b[K"));
}

TEST(Progress, IsSilentWhereThereIsNoTerminal) {
  Drawn drawn(false);
  drawn.update(5000ms, 0.5);
  drawn.tick(9000ms);
  drawn.clear();
  EXPECT_EQ(drawn.text(), "");
}

}  // namespace
}  // namespace steadyrest::apps::cli
