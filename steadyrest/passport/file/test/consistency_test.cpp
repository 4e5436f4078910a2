// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// Each case spoils one thing in a good machine. Exactly one check may complain: that one shows that
// the check works, the absence of others that the checks are independent.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;

Machine good() {
  const auto machine = read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d.toml");
  EXPECT_TRUE(machine);
  return machine.value_or(Machine{});
}

struct Case {
  const char* name;
  std::function<void(Machine&)> spoil;
  std::string_view check;
  Severity severity;
};

std::vector<Case> cases() {
  return {
      {"threads_on_lines",
       [](Machine& m) {
         m.port = kernel::machine::PortKind::lines;
         m.contour.enabled = false;
         m.lines.watchdog_s = 0.5;
         m.lines.programmed_rev_s = 20.0;
         m.lines.spindle.out = {0};
       },
       "threads", Severity::warning},
      {"threads_by_mapping",
       [](Machine& m) {
         m.port = kernel::machine::PortKind::opcua;
         m.opcua.writes.push_back(
             {.quantity = kernel::machine::Quantity::spindle_percent, .node = "s=S"});
       },
       "threads", Severity::warning},
      {"gains", [](Machine& m) { m.axes[1].servo_gain_1_s = 55; }, "servo_gain", Severity::warning},
      {"forward", [](Machine& m) { m.axes[0].feed_forward = 1; }, "feed_forward",
       Severity::warning},
      {"oscillates",
       [](Machine& m) {
         for (Axis& axis : m.axes) {
           // kτ: the gain of 50 1/s times 30 ms is 1.5, beyond the 1 at which the check warns.
           axis.velocity_lag_s = 0.03;
         }
       },
       "servo_gain", Severity::warning},
      {"lag", [](Machine& m) { m.axes[1].velocity_lag_known = false; }, "velocity_lag",
       Severity::note},
      // kT = 50 · 0.1 = 5.
      {"unstable", [](Machine& m) { m.control.servo_period_s = 0.1; }, "servo_gain",
       Severity::error},
      {"drive", [](Machine& m) { m.axes[0].drive_acceleration_au_s2 = 1000; }, "drive_acceleration",
       Severity::warning},
      {"stuck", [](Machine& m) { m.axes[0].friction.breakaway_au_s2 = 7000; }, "friction",
       Severity::error},
      {"rapid", [](Machine& m) { m.control.rapid_mm_s = 5000; }, "path_limits", Severity::note},
      {"no100", [](Machine& m) { m.feed_override.ratio[18] = 0.99; }, "override_100",
       Severity::error},
      {"no0", [](Machine& m) { m.feed_override.ratio[0] = 0.005; }, "override_0",
       Severity::warning},
      {"clipped", [](Machine& m) { m.spindle_override.max_ratio = 0.9; }, "override_max",
       Severity::error},
      {"steps_above_max", [](Machine& m) { m.feed_override.max_ratio = 1.1; }, "override_max",
       Severity::warning},
      // 6 µm a count against a limit of 10 µm: fewer than two counts.
      {"blind", [](Machine& m) { m.axes[2].encoder.count_au = 0.006; }, "contour_limit",
       Severity::error},
      // Half of 21 µm is above the limit of 10 µm.
      {"backlash", [](Machine& m) { m.axes[2].backlash_au = 0.021; }, "contour_limit",
       Severity::warning},
      {"apart",
       [](Machine& m) {
         m.contour.max_ratio = 0.2;
         m.envelope.min_feed_ratio = 0.5;
       },
       "envelope", Severity::error},
      {"narrow", [](Machine& m) { m.contour.max_ratio = 1.5; }, "envelope", Severity::note},
      {"no100_spindle", [](Machine& m) { m.envelope.max_spindle_ratio = 0.9; }, "envelope",
       Severity::error},
      {"stale", [](Machine& m) { m.envelope.stale_after_s = 0.001; }, "stale", Severity::error},
      {"late",
       [](Machine& m) {
         m.port = kernel::machine::PortKind::linuxcnc;
         m.envelope.late_hold_s = 0.05;
       },
       "late", Severity::warning},
      {"no_spindle_switch",
       [](Machine& m) {
         m.chatter.enabled = true;
         m.spindle_override.ratio = {1.0};
       },
       "chatter", Severity::error},
      {"slow", [](Machine& m) { m.feed_override.dead_time_s = 1.0; }, "override_delay",
       Severity::warning},
  };
}

class Consistency : public testing::TestWithParam<Case> {};

TEST_P(Consistency, FindsTheOneThingThatWasSpoilt) {
  Machine machine = good();
  GetParam().spoil(machine);
  const auto found = findings(machine);
  ASSERT_FALSE(found.empty());
  for (const Finding& finding : found) {
    EXPECT_EQ(finding.check, GetParam().check) << finding.what;
    EXPECT_EQ(finding.severity, GetParam().severity) << finding.what;
    EXPECT_FALSE(finding.to_do.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Spoilt, Consistency, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& at) { return at.param.name; });

// The control: a good machine has no finding at all.
TEST(ConsistencyOfAGoodMachine, FindsNothing) {
  EXPECT_TRUE(findings(good()).empty());
}

}  // namespace
}  // namespace steadyrest::passport
