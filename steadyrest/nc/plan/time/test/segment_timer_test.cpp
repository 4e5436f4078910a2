// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>

// The truth is the interpolator, period by period, itself checked against closed forms and LinuxCNC
// (interpolator_test, tests/linuxcnc).
namespace steadyrest::nc::plan {
namespace {

using interpret::EventKind;
using kernel::machine::Machine;
using test::mill;
using test::Program;

/// As examples/machines/linuxcnc-mill.toml.
Machine linuxcnc_mill() {
  Machine m = mill();
  m.control.max_path_acceleration_mm_s2 = 3000.0;
  m.control.max_feed_mm_s = 250.0;
  m.control.corner_tolerance_mm = 10.0;
  m.control.junction_deviation_mm = 0.0;
  m.control.junction_share = 0.1;
  m.control.blend_gap_cycles = 4.0;
  m.control.min_block_cycles = 1.02;
  m.control.merge_share = 1.0;
  m.control.corner_acceleration_share = 0.5;
  m.control.stop_between_rapid_and_feed = true;
  return m;
}

/// A control with a short look-ahead and a long period.
Machine short_sighted() {
  Machine m = mill();
  m.control.look_ahead_blocks = 8;
  m.control.interpolator_period_s = 0.004;
  m.axes[2].max_acceleration_au_s2 = 500.0;
  return m;
}

/// Both timers over the same moves.
class Both final : public interpret::Sink {
 public:
  explicit Both(const Machine& machine)
      : stepped(ProgramTimer::make(machine).value()), closed(SegmentTimer::make(machine).value()) {
    stepped.set_arrival([this](std::uint32_t n, double t_s) { note(stepped_s, n, t_s); });
    closed.set_arrival([this](std::uint32_t n, double t_s) { note(closed_s, n, t_s); });
  }
  void on_move(const interpret::Move& move) override {
    interpret::Move numbered = move;
    numbered.line = ++sequence_;
    stepped.on_move(numbered);
    closed.on_move(numbered);
  }
  void on_event(const interpret::Event& event) override {
    interpret::Event numbered = event;
    numbered.line = ++sequence_;
    stepped.on_event(numbered);
    closed.on_event(numbered);
  }

  struct Difference {
    double total_s = 0.0;
    double of_total_s = 0.0;
    double arrival_s = 0.0;
  };
  Difference difference() {
    const double wanted = stepped.take().value().total_s;
    const double got = closed.take().value();
    note(stepped_s, sequence_ + 1, wanted);
    note(closed_s, sequence_ + 1, got);
    Difference out{wanted, got - wanted, 0.0};
    for (std::size_t i = 0; i < stepped_s.size(); ++i) {
      out.arrival_s = std::max(out.arrival_s, std::abs(stepped_s[i] - closed_s[i]));
    }
    return out;
  }

 private:
  // An item without duration is reached together with the next one.
  static void note(std::vector<double>& to, std::uint32_t n, double t_s) {
    if (n >= to.size()) {
      to.resize(n + 1U, t_s);
    }
  }
  ProgramTimer stepped;
  SegmentTimer closed;
  std::vector<double> stepped_s;
  std::vector<double> closed_s;
  std::uint32_t sequence_ = 0;
};

std::vector<std::string> shared_programs() {
  std::vector<std::string> found;
  std::error_code absent;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           kernel::file::testing::shared_data() / "nc", absent)) {
    if (entry.is_regular_file() && entry.path().extension() != ".MPF") {
      found.push_back(entry.path().string());
    }
  }
  std::ranges::sort(found);
  return found;
}

/// Within `share` of the total, but at least `least_s`, for the total and every arrival.
void expect_near(const Both::Difference& d, double share, double least_s, const std::string& what) {
  const double bound_s = std::max(share * d.total_s, least_s);
  EXPECT_LE(std::abs(d.of_total_s), bound_s) << what << " of " << d.total_s;
  EXPECT_LE(d.arrival_s, bound_s) << what << " of " << d.total_s;
}

TEST(SegmentTimer, AgreesWithTheInterpolatorOnRealProgramsWithinAThousandth) {
  double longest_s = 0.0;
  // Each program begins with another machine, so that a sanitized build covers them all too.
  std::vector<Machine> machines{linuxcnc_mill(), mill(), short_sighted()};
  for (const auto& file : shared_programs()) {
    std::ifstream in(file, std::ios::binary);
    const std::string text = std::string{std::istreambuf_iterator<char>(in), {}} + "\nM2\n";
    std::ranges::rotate(machines, machines.begin() + 1);
    for (const Machine& m : kernel::testing::cases(machines)) {
      Both both(m);
      interpret::Config config;
      config.axes = "XYZ";
      if (!interpret::run_text(text, config, both)) {
        continue;
      }
      const auto d = both.difference();
      longest_s = std::max(longest_s, d.total_s);
      const bool coarse = m.control.interpolator_period_s > 0.001;
      expect_near(d, coarse ? 0.0012 : 0.0004, coarse ? 0.04 : 0.004, file);
    }
  }
  if (longest_s == 0.0) {
    GTEST_SKIP() << "the shared programs are not here";
  }
  EXPECT_GT(longest_s, 1000.0);
}

/// The most that the interpolator's periods cost at a corner: 0.65 of one.
constexpr double kPerMove = 0.65 * 0.001;

TEST(SegmentTimer, SlowsDownBeforeWhatTheLookAheadShows) {
  auto m = mill();
  m.axes[0].max_acceleration_au_s2 = 100.0;
  // 0.05 mm segments: with one block of look-ahead every one must end as if it were the last.
  for (const std::uint32_t blocks : {1U, 2U, 5U, 50U, 500U}) {
    m.control.look_ahead_blocks = blocks;
    Both both(m);
    Program p;
    for (int i = 1; i <= 3000; ++i) {
      p.line(0.05 * i, 0.0, 40.0);
    }
    for (const auto& move : p.moves) {
      both.on_move(move);
    }
    expect_near(both.difference(), 0.0, kPerMove * 3000.0, std::to_string(blocks) + " blocks");
  }
}

TEST(SegmentTimer, AgreesOnRandomPathsWithDwellsToolsAndSpindle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int round = 0; round < 20; ++round) {
    auto m = round % 2 == 0 ? linuxcnc_mill() : mill();
    m.control.tool_change_s = 1.234;
    m.spindle.acceleration_rev_s2 = 30.0;
    Both both(m);
    Program p;
    p.mode = round % 3 == 0 ? interpret::PathMode::exact_path : interpret::PathMode::continuous;
    // 0.03 mm to 30 mm, so that limits of all kinds bind.
    const double step = std::pow(10.0, 1.5 * unit(random));
    for (int i = 0; i < 400; ++i) {
      if (i % 50 == 7) {
        both.on_event({EventKind::tool_change, 0, 1.0 + i});
        both.on_event({EventKind::spindle, 0, 60.0 * unit(random)});
      }
      if (i % 20 == 3) {
        p.rapid(p.at[0] + 50.0 * unit(random), p.at[1] + 50.0 * unit(random));
      } else if (i % 33 == 5) {
        p.dwell(std::abs(unit(random)));
      } else {
        p.line(p.at[0] + step * unit(random), p.at[1] + step * unit(random),
               1.0 + 40.0 * std::abs(unit(random)));
      }
      both.on_move(p.moves.back());
    }
    expect_near(both.difference(), 0.0, kPerMove * 400.0, "round " + std::to_string(round));
  }
}

TEST(SegmentTimer, AFeedPerRevolutionFollowsTheSpindleAsItRampsUp) {
  auto m = mill();
  m.spindle.acceleration_rev_s2 = 5.0;
  Both both(m);
  Program p;
  both.on_event({EventKind::spindle, 0, 10.0});
  p.line(20, 0, 0.1);
  p.moves.back().feed_mode = interpret::FeedMode::per_revolution;
  p.moves.back().spindle_rev_s = 10.0;
  both.on_move(p.moves.back());
  both.on_event({EventKind::spindle, 0, 20.0});
  p.line(40, 0, 0.1);
  p.moves.back().feed_mode = interpret::FeedMode::per_revolution;
  p.moves.back().spindle_rev_s = 20.0;
  both.on_move(p.moves.back());
  const auto d = both.difference();
  // 0.1 mm/rev at 10 rev/s is 1 mm/s: 20 mm in 20 s; then 2 mm/s, 10 s. The waits for 95 % of the
  // speed take 1.9 s and 1.8 s.
  EXPECT_NEAR(d.total_s, 20.0 + 10.0 + 3.8, 0.4);
  expect_near(d, 0.001, 0.02, "per revolution");
}

}  // namespace
}  // namespace steadyrest::nc::plan
