// SPDX-License-Identifier: Apache-2.0
// What the layer advises is what it would have in force at that place if it acted.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest {
namespace {

using kernel::machine::Machine;
using kernel::machine::Mode;
using Path = std::shared_ptr<const nc::plan::PlannedPath>;

/// One cycle of a feed move.
struct Place {
  double position_mm = 0.0;
  double advised_ratio = 1.0;   ///< by the contour room
  double in_force_ratio = 1.0;  ///< let through by the envelope
};

std::vector<Place> course(const Machine& machine, const Path& path, bool path_shown, Mode mode) {
  const auto simulated = sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
  auto layer = supervisor::Supervisor::make(machine, simulated->capability()).value();
  layer.set_mode(mode);
  std::vector<Place> out;
  while (!simulated->finished()) {
    auto frame = simulated->read().value();
    const double at_mm = frame.path_position_mm;
    if (!path_shown) {
      frame.path = {};
    }
    const auto command = layer.update(frame);
    EXPECT_TRUE(!command.write || simulated->write(command).has_value());
    if (frame.motion == kernel::signal::Motion::feed) {
      out.push_back({.position_mm = at_mm,
                     .advised_ratio = layer.estimates().contour->advised_ratio,
                     .in_force_ratio = layer.in_force().feed.ratio});
    }
  }
  return out;
}

/// How many steps of the table from 0 to a ratio; parts of a step count.
double steps(const Machine& machine, double ratio) {
  const auto& table = machine.feed_override.ratio;
  const auto above = std::ranges::upper_bound(table, ratio + 1e-9);
  if (above == table.begin() || above == table.end()) {
    return above == table.begin() ? 0.0 : static_cast<double>(table.size() - 1);
  }
  const double below = *(above - 1);
  return static_cast<double>(above - table.begin() - 1) + (ratio - below) / (*above - below);
}

struct Agreement {
  double share = 0.0;       ///< of the path's length within a step, or within 5 % of the feed
  double mean_ratio = 0.0;  ///< how much higher the advice is
};

Agreement agreement(const Machine& machine, const std::vector<Place>& acts,
                    const std::vector<Place>& advice, double Place::* ratio) {
  Agreement out;
  double length_mm = 0.0;
  std::size_t there = 0;
  for (std::size_t i = 1; i < advice.size(); ++i) {
    const double way_mm = std::max(0.0, advice[i].position_mm - advice[i - 1].position_mm);
    while (there + 1 < acts.size() && acts[there].position_mm < advice[i].position_mm) {
      ++there;
    }
    const double advised = advice[i].*ratio;
    const double in_force = acts[there].in_force_ratio;
    const bool agrees =
        std::abs(steps(machine, advised) - steps(machine, in_force)) <= 1.0 + 1e-6 ||
        std::abs(advised - in_force) <= 0.05;
    length_mm += way_mm;
    out.share += agrees ? way_mm : 0.0;
    out.mean_ratio += way_mm * (advised - in_force);
  }
  out.share /= length_mm;
  out.mean_ratio /= length_mm;
  return out;
}

struct Case {
  const char* name;
  const char* machine;
  const char* program;
  bool path_shown;
  double share;       ///< at least
  double mean_ratio;  ///< at most, either way
};

class Advice : public testing::TestWithParam<Case> {};

TEST_P(Advice, IsWhatWouldBeInForce) {
  const std::string examples = STEADYREST_SOURCE_DIR "/examples/";
  const Machine machine =
      passport::read(examples + "machines/" + GetParam().machine + ".toml").value();
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  const std::string file = examples + "programs/" + GetParam().program;
  const auto path = std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(passport::read_text(file).value(), config, machine, file).value());
  const bool shown = GetParam().path_shown;
  const auto acts = course(machine, path, shown, Mode::act);
  const auto observes = course(machine, path, shown, Mode::observe);
  const auto advises = course(machine, path, shown, Mode::advise);
  for (const Agreement& of : {agreement(machine, acts, observes, &Place::advised_ratio),
                              agreement(machine, acts, advises, &Place::advised_ratio),
                              agreement(machine, acts, advises, &Place::in_force_ratio)}) {
    EXPECT_GE(of.share, GetParam().share);
    EXPECT_NEAR(of.mean_ratio, 0.0, GetParam().mean_ratio);
  }
}
INSTANTIATE_TEST_SUITE_P(
    OnThePath, Advice,
    testing::Values(Case{"pocket_840d", "vmc-840d", "rib-pocket.mpf", true, 0.97, 0.005},
                    Case{"circle_840d", "vmc-840d", "circle-r10.mpf", true, 0.99, 0.005},
                    Case{"pocket_802d", "mill-802d", "rib-pocket.mpf", true, 0.97, 0.01},
                    Case{"pocket_linuxcnc", "linuxcnc-mill", "rib-pocket.ngc", true, 0.9, 0.01},
                    Case{"circle_linuxcnc", "linuxcnc-mill", "circle-r10.ngc", true, 0.98, 0.005}),
    [](const auto& at) { return std::string(at.param.name); });
INSTANTIATE_TEST_SUITE_P(
    WithoutAPath, Advice,
    testing::Values(Case{"pocket_840d", "vmc-840d", "rib-pocket.mpf", false, 0.95, 0.01},
                    Case{"pocket_802d", "mill-802d", "rib-pocket.mpf", false, 0.9, 0.02},
                    Case{"circle_linuxcnc", "linuxcnc-mill", "circle-r10.ngc", false, 0.9, 0.03}),
    [](const auto& at) { return std::string(at.param.name); });

}  // namespace
}  // namespace steadyrest
