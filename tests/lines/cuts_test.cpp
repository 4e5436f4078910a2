// SPDX-License-Identifier: Apache-2.0
// Link, module or process fail at random moments: the control's side goes back to the panel by
// itself, in the machine's own time.
#include <array>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::test::lines {
namespace {

using kernel::machine::Machine;
using kernel::machine::Wiring;
using kernel::outcome::Reason;
using kernel::signal::Frame;

enum class Cut : std::uint8_t { link, module, process };

constexpr int kCuts = 100;
constexpr double kFeed = 0.5;
constexpr double kSpindle = 0.8;
constexpr double kWatchdog_s = 0.1;  ///< of the module, with relays

/// A machine on a long circle whose layer asks for half the feed and four fifths of the speed.
class Scene {
 public:
  enum class Asks : std::uint8_t { both, contour };

  /// `contour`: it is the contour room, with positions, that asks for a lower feed.
  explicit Scene(Wiring wiring, Asks asks = Asks::both) : machine_(wired_840d(0.040)) {
    machine_.contour.enabled = asks == Asks::contour;
    machine_.lines.wiring = wiring;
    Machine real = machine_;
    real.port = kernel::machine::PortKind::sim;
    const auto path = path_of(
        real, asks == Asks::both
                  ? "G17 G90 G94 G71\nS3000 M3\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=900 "
                    "F2000\nM30\n"
                  : "G17 G90 G94 G71 G64\nS3000 M3\nG0 X10 Y-12\nG1 X10 Y0 F4000\nG3 X10 Y0 "
                    "I-10 J0 TURN=9\nM30\n");
    sim_ = sim::SimulatedMachine::make(
               {.machine = real, .path = path, .operator_actions = {}, .cutting = {}})
               .value();
    auto link = std::make_unique<BareLink>();
    link->watchdog_s = wiring == Wiring::relay ? kWatchdog_s : 0.0;
    link_ = link.get();
    chain_ = std::make_unique<LineChain>(machine_, path, std::move(link));
    if (asks == Asks::both) {
      chain_->requests.feed = feed_;
      chain_->requests.spindle = spindle_;
    }
  }

  const Frame& step() {
    frame_ = sim_->read().value();
    auto plc = chain_->cycle(frame_);
    // A relay knows no heartbeat: what it shows is what the control reads.
    plc.heartbeat = machine_.lines.wiring == Wiring::relay ? ++beats_ : plc.heartbeat;
    EXPECT_TRUE(sim_->write(plc));
    return frame_;
  }
  void run(double seconds) {
    for (const double end_s = frame_.time_s + seconds; frame_.time_s < end_s;) {
      step();
    }
  }
  void cut(Cut what) {
    chain_->settle();
    link_->cut = what != Cut::process;
    link_->dead = what == Cut::module;
    if (what == Cut::process) {
      chain_->kill();
    }
  }
  void silence_recorder() { chain_->silence_recorder(); }
  [[nodiscard]] const std::string& last_fault() const { return chain_->last_fault(); }
  void mend(Cut what) {
    link_->cut = false;
    link_->dead = false;
    if (what == Cut::process) {
      chain_->restart();
    }
  }
  [[nodiscard]] bool neutral() const {
    return frame_.feed.effective_ratio == frame_.feed.panel_ratio &&
           frame_.spindle.effective_ratio == frame_.spindle.panel_ratio;
  }
  [[nodiscard]] bool masked() const {
    const auto& lines = machine_.lines;
    return chain_->terminals().outputs[lines.feed.mask] ||
           chain_->terminals().outputs[lines.spindle.mask];
  }
  [[nodiscard]] const Machine& machine() const { return machine_; }
  [[nodiscard]] const Frame& frame() const { return frame_; }

 private:
  Machine machine_;
  std::unique_ptr<sim::SimulatedMachine> sim_;
  BareLink* link_ = nullptr;
  std::unique_ptr<LineChain> chain_;
  Frame frame_;
  std::uint64_t beats_ = 0;
  std::array<kernel::signal::FeedRequest, 1> feed_ = {
      {{.ratio = kFeed, .reason = Reason::contour_limit}}};
  std::array<kernel::signal::SpindleRequest, 1> spindle_ = {
      {{.ratio = kSpindle, .reason = Reason::chatter_better_speed}}};
};

/// README.md, "When something fails": the PLC's limit for the heartbeat, a scan, the dead time,
/// then the ramp.
double stated_plc_s(const Machine& machine) {
  const auto& table = machine.feed_override;
  return machine.envelope.stale_after_s + 2.0 * table.scan_period_s + table.dead_time_s +
         (1.0 - kFeed) / machine.envelope.feed_rise_1_s +
         2.0 * machine.control.interpolator_period_s;
}

class Cuts : public testing::TestWithParam<Cut> {};

TEST_P(Cuts, ThePlcIsNeutralInItsStatedTimeByItsRamp) {
  Scene scene(Wiring::plc);
  std::mt19937 dice(3);  // NOLINT(bugprone-random-generator-seed): the same cases each time
  std::uniform_real_distribution<double> moment_s(0.7, 1.2);
  const double stated_s = stated_plc_s(scene.machine());
  const double most_rise =
      scene.machine().envelope.feed_rise_1_s * scene.machine().feed_override.scan_period_s + 1e-9;
  for (int i = 0; i < kCuts; ++i) {
    scene.run(moment_s(dice));
    ASSERT_EQ(scene.frame().feed.effective_ratio, kFeed) << "the layer acts before each cut";
    ASSERT_EQ(scene.frame().spindle.effective_ratio, kSpindle);
    scene.cut(GetParam());
    const double cut_s = scene.frame().time_s;
    double before = kFeed;
    while (!scene.neutral() && scene.frame().time_s < cut_s + stated_s) {
      const double now = scene.step().feed.effective_ratio;
      ASSERT_LE(now, before + most_rise) << "no jump upwards";
      before = now;
    }
    ASSERT_TRUE(scene.neutral()) << "cut " << i << " at " << cut_s << " s";
    scene.run(0.1);
    ASSERT_TRUE(scene.neutral()) << "and stays so";
    scene.mend(GetParam());
  }
}

TEST_P(Cuts, TheRelayFallsInTheWatchdogsTime) {
  Scene scene(Wiring::relay);
  std::mt19937 dice(4);  // NOLINT(bugprone-random-generator-seed): the same cases each time
  std::uniform_real_distribution<double> moment_s(0.7, 1.2);
  const double cycle_s = scene.machine().control.interpolator_period_s;
  const double stated_s = GetParam() == Cut::module ? 2.0 * cycle_s : kWatchdog_s + 2.0 * cycle_s;
  for (int i = 0; i < kCuts; ++i) {
    scene.run(moment_s(dice));
    ASSERT_TRUE(scene.masked());
    scene.cut(GetParam());
    const double cut_s = scene.frame().time_s;
    while (scene.masked() && scene.frame().time_s < cut_s + stated_s) {
      scene.step();
    }
    ASSERT_FALSE(scene.masked()) << "cut " << i << " at " << cut_s << " s";
    scene.run(0.3);
    ASSERT_FALSE(scene.masked());
    scene.mend(GetParam());
  }
}

/// No word of the layer outlives its positions, and handing back is no jump with any wiring.
TEST(RecorderFails, TheFeedGoesBackByTheRampAndThenTheFaultIsTold) {
  for (const Wiring wiring : {Wiring::relay, Wiring::plc}) {
    Scene scene(wiring, Scene::Asks::contour);
    scene.run(4.0);
    double before = scene.frame().feed.effective_ratio;
    ASSERT_LT(before, 0.8);
    scene.silence_recorder();
    const double most_step = 0.1 + 1e-9;  // of the switch
    // Without the recorder's clock the ramp runs by the computer's.
    const double from_s = kernel::link::monotonic_s();
    while (before < 1.0 && kernel::link::monotonic_s() < from_s + 60.0) {
      kernel::link::Event().wait(0.001);
      const double now = scene.step().feed.effective_ratio;
      ASSERT_LE(now, before + most_step);
      before = now;
    }
    EXPECT_EQ(before, 1.0);
    EXPECT_GT(kernel::link::monotonic_s(), from_s + 0.1) << "it took several positions";
    scene.run(0.3);
    EXPECT_FALSE(scene.masked());
    EXPECT_NE(scene.last_fault().find("the recorder sends nothing"), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Cuts, testing::Values(Cut::link, Cut::module, Cut::process),
                         [](const auto& what) {
                           return what.param == Cut::link     ? "link"
                                  : what.param == Cut::module ? "module"
                                                              : "process";
                         });

}  // namespace
}  // namespace steadyrest::test::lines
