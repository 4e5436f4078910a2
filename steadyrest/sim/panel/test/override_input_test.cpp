// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/panel/override_input.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::OverrideTable;
using test::code_of;

/// 0, 10 … 120 %, Gray.
OverrideTable switch_table() {
  OverrideTable table;
  for (std::uint32_t i = 0; i <= 12; ++i) {
    table.ratio.push_back(0.1 * i);
    table.code.push_back(kernel::override::gray_code(i + 1));
  }
  table.scan_period_s = 0.010;
  table.dead_time_s = 0.025;
  return table;
}

/// Drives one input in time.
class Bench {
 public:
  explicit Bench(const OverrideTable& table)
      : input_(
            *OverrideInput::make({.table = table, .watchdog_s = 0.1, .hand_back_rise_1_s = 2.0})) {
    words_.panel_code = code_of(100);
  }

  kernel::signal::OverrideState step(bool alive = true) {
    words_.time_s = 0.001 * ++tick_;
    words_.heartbeat += alive ? 1U : 0U;
    return input_.update(words_);
  }
  kernel::signal::OverrideState run(double seconds, bool alive = true) {
    kernel::signal::OverrideState last;
    for (int i = 0; i < static_cast<int>(seconds * 1000.0 + 0.5); ++i) {
      last = step(alive);
    }
    return last;
  }
  void layer(int percent) {
    words_.layer_code = code_of(percent);
    words_.layer_masks = true;
  }
  OverrideInput::Input& words() { return words_; }

 private:
  OverrideInput input_;
  OverrideInput::Input words_;
  int tick_ = 0;
};

// A change just after a scan waits a whole scan (10 ms), then the dead time (25 ms).
TEST(OverrideInput, ActsAfterTheScanAndTheDeadTime) {
  Bench bench(switch_table());
  bench.run(0.1);  // now at 0.100 s, just scanned
  bench.words().panel_code = code_of(50);
  double acted_after_s = 0.0;
  for (int i = 1; i <= 100 && acted_after_s == 0.0; ++i) {
    if (bench.step().effective_ratio < 0.75) {
      acted_after_s = 0.001 * i;
    }
  }
  EXPECT_NEAR(acted_after_s, 0.010 + 0.025, 1e-9);
}

// min(layer, panel), the operator's rule.
TEST(OverrideInput, LayerMasksButNeverExceedsThePanel) {
  Bench bench(switch_table());
  bench.layer(70);
  EXPECT_NEAR(bench.run(0.1).effective_ratio, 0.7, 1e-12);
  bench.layer(120);
  EXPECT_NEAR(bench.run(0.1).effective_ratio, 1.0, 1e-12);
  bench.words().panel_code = code_of(40);
  EXPECT_NEAR(bench.run(0.1).effective_ratio, 0.4, 1e-12);
}

// Above the panel, but never above a panel at 0.
TEST(OverrideInput, LayerExceedsThePanelOnlyWhereTheMachineFileSaysSo) {
  OverrideTable table = switch_table();
  table.layer_may_exceed_panel = true;
  Bench bench(table);
  bench.layer(120);
  EXPECT_NEAR(bench.run(0.1).effective_ratio, 1.2, 1e-12);
  bench.words().panel_code = code_of(0);
  EXPECT_EQ(bench.run(0.1).effective_ratio, 0.0);
}

// An unknown word is no word: the mask drops.
TEST(OverrideInput, UnknownLayerCodeKeepsThePanels) {
  Bench bench(switch_table());
  bench.layer(50);
  bench.run(0.2);
  bench.words().layer_code = 0x55;
  EXPECT_NEAR(bench.run(1.0).effective_ratio, 1.0, 1e-12);
}

// Between two detents a switch shows no code: the operator's last value stays.
TEST(OverrideInput, UnknownPanelCodeKeepsTheLastKnown) {
  Bench bench(switch_table());
  bench.words().panel_code = code_of(60);
  bench.run(0.1);
  bench.words().panel_code = 0;
  const auto state = bench.run(0.2);
  EXPECT_FALSE(state.panel_code_known);
  EXPECT_NEAR(state.effective_ratio, 0.6, 1e-12);
  EXPECT_NEAR(state.panel_ratio, 0.6, 1e-12);
}

// Watchdog 0.1 s, then at most a scan and the dead time; the way up at 2 1/s in scans of 10 ms.
TEST(OverrideInput, LostHeartbeatReturnsToThePanelWithoutAJump) {
  Bench bench(switch_table());
  bench.layer(30);
  EXPECT_NEAR(bench.run(0.5).effective_ratio, 0.3, 1e-12);
  double before = 0.3;
  double largest_rise = 0.0;
  double left_at_s = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const double now = bench.step(false).effective_ratio;
    largest_rise = std::max(largest_rise, now - before);
    if (left_at_s == 0.0 && now > 0.3 + 1e-9) {
      left_at_s = 0.001 * i;
    }
    before = now;
  }
  EXPECT_NEAR(before, 1.0, 1e-12);
  EXPECT_LE(largest_rise, 2.0 * 0.010 + 1e-12);  // one scan's share of 2/s
  EXPECT_GE(left_at_s, 0.1);
  EXPECT_LE(left_at_s, 0.1 + 0.010 + 0.025 + 0.001);
}

// Handing back is a ramp upwards; downwards the value follows the operator at once.
TEST(OverrideInput, HandingBackNeverHoldsAgainstTheOperator) {
  Bench bench(switch_table());
  bench.layer(30);
  bench.run(0.5);
  bench.run(0.2, false);  // on the way up
  bench.words().panel_code = code_of(0);
  EXPECT_EQ(bench.run(0.05, false).effective_ratio, 0.0);
}

// Gray neighbours differ in one bit. A jump over several steps changes several bits, one scan sees
// only the first of them, and some of the words between decode outside what was asked.
TEST(OverrideInput, AWordThatIsNotLatchedShowsWhatLiesBetween) {
  OverrideTable table = switch_table();
  table.latched_word = false;
  table.dead_time_s = 0.0;
  const auto seen_between = [&](int from, int to) {
    Bench bench(table);
    bench.layer(from);
    bench.run(0.1);
    bench.layer(to);
    std::vector<double> seen;
    for (int i = 0; i < 30; ++i) {
      seen.push_back(bench.step().effective_ratio);
    }
    return seen;
  };
  for (int percent = 10; percent < 100; percent += 10) {  // neighbours: one bit, nothing between
    for (const double ratio : seen_between(percent, percent + 10)) {
      EXPECT_GE(ratio, percent * 0.01 - 1e-9);
      EXPECT_LE(ratio, percent * 0.01 + 0.1 + 1e-9);
    }
  }
  bool outside = false;
  for (int to = 20; to <= 100; to += 10) {
    for (const double ratio : seen_between(10, to)) {
      outside = outside || ratio < 0.1 - 1e-9 || ratio > to * 0.01 + 1e-9;
    }
  }
  EXPECT_TRUE(outside);  // somewhere a jump decodes to what nobody asked for
}

// Any words, masks and heartbeats. For 36 ms (scan and dead time) the previous panel may still act;
// then the new one must apply.
TEST(OverrideInput, StaysWithinPanelAndTableWhateverTheWordsAre) {
  EXPECT_TRUE(rc::check("effective ≤ largest panel of the last scans; panel 0 stops", [] {
    Bench bench(switch_table());
    double panel_high = 1.0;
    bench.run(0.1);
    const auto codes = *rc::gen::container<std::vector<int>>(20, rc::gen::inRange(0, 40));
    for (std::size_t i = 0; i + 1 < codes.size(); i += 2) {
      bench.words().layer_code = static_cast<std::uint32_t>(codes[i]);
      bench.words().layer_masks = codes[i] % 3 != 0;
      const int panel = codes[i + 1] % 13;
      bench.words().panel_code = code_of(panel * 10);
      for (int j = 0; j < 60; ++j) {
        const double effective = bench.step(codes[i] % 5 != 0).effective_ratio;
        const double allowed = j < 36 ? std::max(panel_high, 0.1 * panel) : 0.1 * panel;
        RC_ASSERT(effective <= allowed + 1e-9);
        RC_ASSERT(effective >= 0.0);
      }
      panel_high = 0.1 * panel;
    }
  }));
}

// No table, a dead time of thirty years, no period.
TEST(OverrideInput, RefusesABadTable) {
  EXPECT_FALSE(OverrideInput::make({}));
  OverrideTable table = switch_table();
  table.dead_time_s = 1e9;
  EXPECT_FALSE(OverrideInput::make({.table = table}));
  EXPECT_FALSE(OverrideInput::make({.table = switch_table(), .period_s = 0.0}));
}

}  // namespace
}  // namespace steadyrest::sim
