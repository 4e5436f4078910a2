// SPDX-License-Identifier: Apache-2.0
// When the machine reaches the lines of a program: dwells, whose times are known, are the truth.
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/walk/clock.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::Workshop;

/// Walks a program and asks for the time of some lines.
class TimedWalk {
 public:
  explicit TimedWalk(const std::string& program) {
    test::write_file(shop_.original(), program);
    survey_ = survey(shop_.original(), shop_.config).value();
  }
  [[nodiscard]] Clock::Told teller() {
    return [this](std::uint64_t ticket, double time_s) { time_s_[ticket] = time_s; };
  }
  /// Runs through the program with a clock; returns its total time, or −1 where it is refused.
  double run(Clock& clock, const std::map<std::uint32_t, std::uint64_t>& asked) {
    const auto walk = Walk::make(shop_.original(), shop_.config, survey_, shop_.settings).value();
    while (walk->step()) {
      if (const auto at = asked.find(walk->line()); at != asked.end()) {
        clock.ask(at->second);
      }
      clock.feed(*walk);
    }
    const auto total = clock.finish();
    return total ? *total : -1.0;
  }
  [[nodiscard]] const kernel::machine::Machine& machine() const { return shop_.machine; }
  [[nodiscard]] const std::map<std::uint64_t, double>& told() const { return time_s_; }

 private:
  Workshop shop_;
  Survey survey_;
  std::map<std::uint64_t, double> time_s_;
};

// Dwells of 2, 3 and 5 s, and nothing moves: lines are reached at their sums.
TEST(Clock, TellsWhenALineIsReached) {
  TimedWalk program("G21 G90\nG4 P2\nG4 P3\nG4 P5\nM2\n");
  const auto clock = Clock::make(program.machine(), program.teller()).value();
  EXPECT_NEAR(program.run(*clock, {{2, 20}, {3, 30}, {4, 40}, {5, 50}}), 10.0, 1e-9);
  EXPECT_NEAR(program.told().at(20), 0.0, 1e-9);
  EXPECT_NEAR(program.told().at(30), 2.0, 1e-9);
  EXPECT_NEAR(program.told().at(40), 5.0, 1e-9);
  EXPECT_NEAR(program.told().at(50), 10.0, 1e-9) << "what takes no time comes with the end";
}

// 60 mm at 600 mm/min take 6 s, and a little for starting and stopping.
TEST(Clock, TimesMovesAsTheMachineMakesThem) {
  TimedWalk program("G21 G90 G61.1\nG1 X60 F600\nG1 X0\nM2\n");
  const auto clock = Clock::make(program.machine(), program.teller()).value();
  const double total_s = program.run(*clock, {{2, 1}, {3, 2}});
  EXPECT_GE(total_s, 12.0);
  EXPECT_LT(total_s, 12.5);
  EXPECT_NEAR(program.told().at(2), 0.5 * total_s, 0.02);
}

// A subprogram repeats its line: each call is told, in order.
TEST(Clock, TellsEachCallOfASubprogram) {
  TimedWalk program("G21 G90\no1 sub\nG4 P2\no1 endsub\no1 call\no1 call\no1 call\nM2\n");
  std::vector<double> times_s;
  const auto clock = Clock::make(program.machine(), [&](std::uint64_t, double time_s) {
                       times_s.push_back(time_s);
                     }).value();
  EXPECT_NEAR(program.run(*clock, {{3, 7}}), 6.0, 1e-9);
  // The first is the definition, which is passed over.
  EXPECT_THAT(times_s, testing::ElementsAre(0.0, 0.0, 2.0, 4.0));
}

// Known times come from a walk just before: nothing is planned again.
TEST(Clock, OfKnownTimesTellsThem) {
  TimedWalk program("G21 G90\nG4 P2\nG4 P3\nM2\n");
  const KnownTimes known{.line_s = {{2, 100.0}, {3, 200.0}}, .program_s = 300.0};
  const auto clock = Clock::of(known, program.teller());
  EXPECT_EQ(program.run(*clock, {{2, 1}, {3, 2}}), 300.0);
  EXPECT_EQ(program.told().at(1), 100.0);
  EXPECT_EQ(program.told().at(2), 200.0);
}

// A line that was not timed may not pass for one at time 0.
TEST(Clock, OfKnownTimesRefusesALineThatItDoesNotKnow) {
  TimedWalk program("G21 G90\nG4 P2\nG4 P3\nM2\n");
  const KnownTimes known{.line_s = {{2, 100.0}}, .program_s = 300.0};
  const auto clock = Clock::of(known, program.teller());
  EXPECT_EQ(program.run(*clock, {{3, 2}}), -1.0);
  EXPECT_TRUE(program.told().empty());
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
