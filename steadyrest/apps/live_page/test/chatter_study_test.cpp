// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/chatter_study.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Result;

constexpr double kDepth_mm = 0.6;

chatter::offline::Process slot() {
  return chatter::offline::read_process(STEADYREST_SOURCE_DIR "/examples/processes/slot-922hz.toml")
      .value();
}

/// A run whose spindle has been programmed to S5000.
class Study : public testing::Test {
 protected:
  Study() {
    nc::interpret::Config config;
    config.dialect = machine_.machine.control.dialect;
    config.axes = "XYZ";
    const auto path = std::make_shared<const nc::plan::PlannedPath>(
        nc::plan::plan_text("G90 G94 G71 S5000 M3\nG1 X60 F1000\nM30\n", config, machine_.machine,
                            "slot.mpf")
            .value());
    port_ = sim::SimulatedMachine::make({.machine = machine_.machine, .path = path}).value();
    loop_.emplace(
        *port_, *machine_.layer, machine_.pace,
        steadyrest::live::Loop::Config{.period_s = machine_.machine.control.interpolator_period_s,
                                       .contour_limit_mm = 0.01,
                                       .most_cycles = 200});
    desk_.emplace(Desk{
        .asked = {.loop = *loop_, .port = "sim"},
        .tap = tap_,
        .machine = machine_.machine,
        .machine_file = {},
        .records = {},
        .writing = {},
        .findings = {},
        .chatter =
            ChatterDesk{.process = slot(), .depth_mm = kDepth_mm, .acts = true, .plan = plan()}});
  }

  /// Fakes the planner.
  static decltype(ChatterDesk::plan) plan() {
    return [](const Machine&, double programmed_rev_s, const auto& progress) -> Result<Json> {
      progress(0.5);
      if (programmed_rev_s < 1.0) {
        return kernel::outcome::refuse("too slow", "turn faster");
      }
      return Json{{"decision", "keep"}, {"programmed_rpm", 60.0 * programmed_rev_s}};
    };
  }

  /// Asks until it is there; a minute at most.
  template <class Ask>
  static Json until_done(const char* key, Ask ask) {
    for (int i = 0; i < 6000; ++i) {
      const web::Response got = ask();
      EXPECT_EQ(got.status, 200U) << got.body;
      const Json answer = Json::parse(got.body);
      EXPECT_GE(answer["progress"], 0.0);
      EXPECT_LE(answer["progress"], 1.0);
      if (!answer[key].is_null()) {
        return answer;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "it is not done";
    return {};
  }

  steadyrest::live::test::Desk machine_;
  steadyrest::live::Tap tap_;
  std::unique_ptr<sim::SimulatedMachine> port_;
  std::optional<steadyrest::live::Loop> loop_;
  std::optional<Desk> desk_;
};

TEST_F(Study, ComputesMapAndBorderOfTheSpindlesSpeeds) {
  // A coarse map, and not behind all other tests.
  ChatterStudy study(*desk_, {.speeds = 27, .depths = 13, .niceness = 0});
  const Json answer = until_done("lobes", [&] { return study.lobes(); });
  EXPECT_EQ(answer["progress"], 1.0);
  const Json& lobes = answer["lobes"];
  EXPECT_EQ(lobes["depth_mm"], kDepth_mm);
  const auto speeds = lobes["map"]["speed_rpm"].get<std::vector<double>>();
  const auto depths = lobes["map"]["depth_mm"].get<std::vector<double>>();
  const auto radius = lobes["map"]["log_radius"].get<std::vector<double>>();
  ASSERT_EQ(radius.size(), speeds.size() * depths.size());
  EXPECT_NEAR(speeds.back(), 60.0 * machine_.machine.spindle.max_rev_s, 0.01);
  const auto border_rpm = lobes["border"]["speed_rpm"].get<std::vector<double>>();
  EXPECT_TRUE(std::ranges::is_sorted(border_rpm));
  EXPECT_EQ(border_rpm.front(), speeds.front());
  EXPECT_EQ(border_rpm.back(), speeds.back());
  // The border is that of one speed alone, and the map changes its sign there.
  for (std::size_t i = 0; i < border_rpm.size(); i += border_rpm.size() / 12) {
    const auto limit =
        chatter::offline::limit_depth_mm(slot(), border_rpm[i] / 60.0, {}, depths.back()).value();
    const Json& at = lobes["border"]["depth_mm"][i];
    ASSERT_EQ(at.is_null(), !limit.has_value()) << border_rpm[i];
    if (limit) {
      EXPECT_NEAR(at.get<double>(), *limit, 0.01 * *limit + 1e-3) << border_rpm[i];
    }
  }
  for (std::size_t s = 0; s < speeds.size(); s += 4) {
    const auto limit =
        chatter::offline::limit_depth_mm(slot(), speeds[s] / 60.0, {}, depths.back()).value();
    for (std::size_t d = 0; d < depths.size(); ++d) {
      if (limit && std::abs(depths[d] - *limit) > 0.02 && depths[d] < *limit) {
        EXPECT_LT(radius[s * depths.size() + d], 0.0) << speeds[s] << " " << depths[d];
      }
    }
  }
  EXPECT_EQ(Json::parse(study.lobes().body), answer) << "computed once";
}

TEST_F(Study, PlansForTheProgrammedSpeed) {
  ChatterStudy study(*desk_);
  const Json before = Json::parse(study.plan().body);
  EXPECT_EQ(before["programmed_rpm"], 0.0);
  EXPECT_TRUE(before["plan"].is_null());
  loop_->run();
  study.look();
  const Json answer = until_done("plan", [&] { return study.plan(); });
  EXPECT_NEAR(answer["programmed_rpm"].get<double>(), 5000.0, 1e-6);
  EXPECT_NEAR(answer["plan"]["programmed_rpm"].get<double>(), 5000.0, 1e-6);
}

TEST_F(Study, ARefusedPlanIsARefusal) {
  desk_->chatter->plan = [](const Machine&, double, const auto&) -> Result<Json> {
    return kernel::outcome::refuse("no modes", "add one");
  };
  ChatterStudy study(*desk_, {.niceness = 0});
  loop_->run();
  study.look();
  web::Response got;
  for (int i = 0; i < 6000 && got.status != 422; ++i) {
    got = study.plan();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(got.status, 422U);
  EXPECT_EQ(Json::parse(got.body)["error"]["what"], "no modes");
}

TEST_F(Study, WithoutAProcessThereIsNone) {
  desk_->chatter.reset();
  ChatterStudy study(*desk_);
  EXPECT_EQ(study.lobes().status, 404U);
  EXPECT_EQ(study.plan().status, 404U);
}

// A map this fine takes minutes; whoever ends the run does not wait for all of it.
TEST_F(Study, EndsInTheMiddleOfItsWork) {
  auto study = std::make_unique<ChatterStudy>(
      *desk_, ChatterStudy::Config{.speeds = 200'000, .niceness = 0});
  while (Json::parse(study->lobes().body)["progress"] == 0.0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const auto begun = std::chrono::steady_clock::now();
  study.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(20));
}

}  // namespace
}  // namespace steadyrest::apps::live_page
