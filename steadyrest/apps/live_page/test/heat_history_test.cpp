// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/heat_history.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Mode;
using testing::Each;
using testing::Ge;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kWarmUp_s = 60.0;
constexpr double kLevel_um = 30.0;  ///< of Z at 3000 rpm

kernel::machine::Machine warm_mill() {
  auto machine = passport::read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d.toml").value();
  machine.control.interpolator_period_s = machine.control.servo_period_s = 0.004;
  machine.spindle.acceleration_rev_s2 = 1000.0;
  machine.envelope.max_offset_mm = 0.1;
  machine.envelope.offset_slew_mm_s = 0.05;
  machine.thermal.enabled = true;
  machine.thermal.slope_mm_s = 0.01;
  kernel::machine::ThermalAxis z;
  z.name = "Z";
  z.mode.emplace_back();
  z.mode[0].tau_s = kWarmUp_s;
  z.mode[0].speed_rev_s = {0.0, 50.0};
  z.mode[0].level_mm = {0.0, 1e-3 * kLevel_um};
  machine.thermal.axis = {z};
  return machine;
}

/// A minute's cut at 3000 rpm, then a minute with the spindle still turning, seen by the page.
struct Shift {
  explicit Shift(Mode mode) : machine(warm_mill()) {
    nc::interpret::Config config;
    config.dialect = machine.control.dialect;
    config.axes = "XYZ";
    std::string text = "G17 G90 G94 G71\nS3000 M3\n";
    for (int n = 0; n < 30; ++n) {
      text += "G1 X100 F6000\nG1 X0 F6000\n";
    }
    const auto path = std::make_shared<const nc::plan::PlannedPath>(
        nc::plan::plan_text(text + "G4 F60\nM30\n", config, machine, "shift.mpf").value());
    port = sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
    layer.emplace(supervisor::Supervisor::make(machine, port->capability()).value());
    steadyrest::live::Loop::Config how{.period_s = 0.004, .mode = mode, .most_cycles = 30'000};
    how.tap = tap.get();
    std::uint64_t cycles = 0;
    how.on_command = [this, cycles](const auto& /*command*/) mutable {
      if (++cycles % 8 == 0) {
        heat->update(0.004 * static_cast<double>(cycles));
      }
      if (cycles == 29'000) {  // before the end, where the layer hands back
        shown = Json::parse(heat->show().body)["thermal"];
      }
    };
    loop = std::make_unique<steadyrest::live::Loop>(*port, *layer, pace, how);
    desk.emplace(Desk{.asked = {.loop = *loop, .port = "sim"},
                      .tap = *tap,
                      .machine = machine,
                      .machine_file = {},
                      .records = {},
                      .writing = {},
                      .findings = {},
                      .chatter = {}});
    heat.emplace(*desk);
  }
  Json run() {
    loop->run();
    return shown;
  }
  Json shown;
  kernel::machine::Machine machine;
  std::unique_ptr<sim::SimulatedMachine> port;
  std::optional<supervisor::Supervisor> layer;
  steadyrest::live::test::FakePace pace;
  std::unique_ptr<steadyrest::live::Tap> tap = std::make_unique<steadyrest::live::Tap>();
  std::unique_ptr<steadyrest::live::Loop> loop;
  std::optional<Desk> desk;
  std::optional<HeatHistory> heat;
};

TEST(HeatHistory, ShowsTheCyclogramThatTheModelWasGiven) {
  const Json shown = Shift(Mode::observe).run();
  const Json& cyclogram = shown["cyclogram"];
  ASSERT_THAT(cyclogram["t_s"], SizeIs(Ge(10)));
  for (std::size_t i = 1; i < cyclogram["t_s"].size(); ++i) {
    const double t_s = cyclogram["t_s"][i];
    EXPECT_NEAR(cyclogram["speed_rpm"][i], 3000.0, 5.0) << t_s;
    if (t_s > 20.0 && t_s < 60.0) {
      EXPECT_NEAR(cyclogram["cutting_percent"][i], 100.0, 1.0) << t_s;
      EXPECT_GT(cyclogram["feed_mm_min"][i], 4500.0) << t_s;
    } else if (t_s > 85.0) {
      EXPECT_EQ(cyclogram["cutting_percent"][i], 0.0) << t_s;
      EXPECT_EQ(cyclogram["feed_mm_min"][i], 0.0) << t_s;
    }
  }
  const Json& z = shown["history"]["axes"][0];
  const double t_s = shown["history"]["t_s"].back();
  EXPECT_NEAR(z["displacement_um"].back(), kLevel_um * (1.0 - std::exp(-t_s / kWarmUp_s)), 0.4);
  EXPECT_THAT(z["offset_um"], Each(0.0));
  EXPECT_THAT(shown["corrections"]["done"], IsEmpty());
  EXPECT_EQ(shown["next"], nullptr) << "nothing is corrected in observe";
}

TEST(HeatHistory, ListsWhatWasCorrectedAndWhatComesNext) {
  const Json shown = Shift(Mode::act).run();
  const Json& done = shown["corrections"]["done"];
  ASSERT_THAT(done, SizeIs(Ge(5)));
  EXPECT_EQ(done[0]["from_um"], 0.0);
  for (std::size_t i = 1; i < done.size(); ++i) {
    EXPECT_EQ(done[i]["axis"], "Z");
    EXPECT_EQ(done[i]["from_um"], done[i - 1]["to_um"]);
    EXPECT_GE(done[i]["t_s"], done[i - 1]["t_s"]);
  }
  const Json& next = shown["next"];
  EXPECT_EQ(next["axis"], "Z");
  const double after_um = done.back()["to_um"];
  EXPECT_NEAR(next["change_um"], -1.0, 0.2);
  EXPECT_NEAR(next["offset_um"], after_um + next["change_um"].get<double>(), 2e-3);
  // The offset follows −δ, and the spindle turns on.
  const double at_s = -kWarmUp_s * std::log(1.0 + (after_um - 1.0) / kLevel_um);
  const double now_s = shown["history"]["t_s"].back();
  EXPECT_NEAR(now_s + next["in_s"].get<double>(), at_s, 12.0);
  const Json& z = shown["outlook"]["axes"][0];
  EXPECT_NEAR(z["displacement_um"].back(), kLevel_um, 0.05) << "an hour is 60 time constants";
  EXPECT_NEAR(z["offset_um"].back(), -kLevel_um, 0.1);
  EXPECT_THAT(shown["outlook"]["in_s"], SizeIs(61));
}

}  // namespace
}  // namespace steadyrest::apps::live_page
