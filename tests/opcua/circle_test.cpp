// SPDX-License-Identifier: Apache-2.0
// The whole circle over OPC UA: simulated machine and shipped actions, a node-opcua server, the
// bridge, port, path and supervisor. R = 10 mm at F4000 with a limit of 10 µm.
#include <algorithm>
#include <cmath>

#include <bench/clairvoyant/simulated_schedule.hpp>
#include <gtest/gtest.h>
#include <tests/opcua/live_rig.hpp>
#include <tests/opcua/scene.hpp>

#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>
#include <steadyrest/trial/cut/true_error.hpp>

namespace steadyrest::opcua {
namespace {

using kernel::machine::Machine;

std::shared_ptr<const nc::plan::PlannedPath> circle_r10(const Machine& of) {
  nc::interpret::Config config;
  config.dialect = of.control.dialect;
  return std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_file(STEADYREST_SOURCE_DIR "/examples/programs/circle-r10.mpf", config, of)
          .value());
}

struct Figures {
  double time_s = 0.0;
  double largest_mm = 0.0;
  std::size_t cut = 0;
  std::size_t over = 0;
  std::size_t undelivered = 0;
};

/// The part is cut whole, the layer in act mode.
Figures cut(Rig& rig, const std::shared_ptr<const nc::plan::PlannedPath>& path) {
  live::FollowedPort followed(*rig.port);
  followed.offer(std::make_shared<const nc::follow::Route>(path->segments));
  auto layer = supervisor::Supervisor::make(rig.machine, followed.capability()).value();
  layer.set_mode(kernel::machine::Mode::act);
  auto judge = trial::cut::TrueError::make(rig.machine, nullptr).value();
  Figures out;
  const auto look = [&] {
    const auto error = judge.update(rig.control.frame(), rig.control.truth()).own;
    const auto& path_now = rig.control.frame().path;
    if (rig.control.frame().motion != kernel::signal::Motion::feed || !error.valid ||
        !error.from_path || path_now[error.foot_index].motion != kernel::signal::Motion::feed) {
      return;
    }
    ++out.cut;
    out.over += std::abs(error.error_mm) > rig.machine.contour.limit_mm ? 1 : 0;
    out.largest_mm = std::max(out.largest_mm, std::abs(error.error_mm));
  };
  for (int i = 0; i < 4000 && !rig.control.finished() && !testing::Test::HasFailure(); ++i) {
    rig.advance(look);
    const auto frame = followed.read();
    EXPECT_TRUE(frame) << kernel::outcome::text(frame.error());
    const auto command = layer.update(frame ? *frame : kernel::signal::Frame());
    if (command.write) {
      out.undelivered += rig.write(command, 30.0) ? 0 : 1;
    }
  }
  out.time_s = rig.control.time_s();
  return out;
}

double clairvoyant_s(const Machine& of, const std::shared_ptr<const nc::plan::PlannedPath>& path) {
  trial::cut::Job job{.machine = of, .path = path};
  job.machine.port = kernel::machine::PortKind::sim;
  return bench::clairvoyant::yardstick_of(job, [](const auto&) {}).value().figures.cycle_time_s;
}

class Circle : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Circle, KeepsItsLimitWithinTenPercentOfTheClairvoyant) {
  const auto [dead_ms, cycle_ms] = GetParam();
  Machine of = machine();
  of.opcua.cycle_s = 1e-3 * cycle_ms;
  of.opcua.reply_s = 10.0;  // a busy computer's
  of.feed_override.dead_time_s = 1e-3 * dead_ms;
  give_state_folder(of);
  const auto path = circle_r10(of);
  Rig rig({.machine = of, .path = path, .order_delay_s = 1e-3 * dead_ms});
  const Figures figures = cut(rig, path);
  const double best_s = clairvoyant_s(of, path);
  RecordProperty("time_s", std::to_string(figures.time_s));
  std::printf(
      "dead time %d ms, cycle %d ms: %.2f s, clairvoyant %.2f s, largest %.2f um, over %zu of "
      "%zu\n",
      dead_ms, cycle_ms, figures.time_s, best_s, 1e3 * figures.largest_mm, figures.over,
      figures.cut);
  EXPECT_TRUE(rig.control.finished());
  EXPECT_EQ(figures.undelivered, 0U);
  EXPECT_LE(figures.largest_mm, of.contour.limit_mm);
  EXPECT_LE(figures.time_s, 1.10 * best_s);
  // Without the layer: 10.8 s and 89 µm. Faster than the clairvoyant is no feat but an error here.
  EXPECT_GE(figures.time_s, 0.98 * best_s);
}

INSTANTIATE_TEST_SUITE_P(DeadTimes, Circle, testing::Values(std::pair(40, 20), std::pair(100, 20)));

}  // namespace
}  // namespace steadyrest::opcua
