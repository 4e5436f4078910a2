// SPDX-License-Identifier: Apache-2.0
// Contour error cancelled by offsets on a control that moves them slowly, as LinuxCNC does with its
// share of the axis's acceleration: hardly worse than without, and better where there is time.
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/offset_course.hpp>
#include <steadyrest/adapters/linuxcnc/testing/offset_planner.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest {
namespace {

using adapters::linuxcnc::OffsetCourse;
using adapters::linuxcnc::testing::OffsetPlanner;
using kernel::machine::Machine;
using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;

constexpr double kAcceleration_mm_s2 = 400.0;  // OFFSET_AV_RATIO 0.2 of 2000 mm/s²

/// The simulated machine with the planner of LinuxCNC's external offsets before its path offset,
/// and the course by which the port leads it.
class SlowOffsets final : public kernel::port::Port {
 public:
  explicit SlowOffsets(Port& machine) : machine_(machine) {}
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    auto capability = machine_.capability();
    capability.path_offset_acceleration_mm_s2 = kAcceleration_mm_s2;
    return capability;
  }
  Result<Frame> read() noexcept override { return machine_.read(); }
  Result<void> write(const Command& command) noexcept override {
    Command moved = command;
    adapters::linuxcnc::Pins pins;
    for (std::size_t i = 0; i < 3; ++i) {
      pins.path_offset[i] = command.path_offset_mm[i];
    }
    course_.apply(pins, true, ++tick_, 0.001);
    for (std::size_t i = 0; i < 3; ++i) {
      moved.path_offset_mm[i] = planner_[i].update(pins.path_offset[i]);
    }
    return machine_.write(moved);
  }

 private:
  Port& machine_;
  OffsetCourse course_{
      {.acceleration = {kAcceleration_mm_s2, kAcceleration_mm_s2, kAcceleration_mm_s2}}};
  std::array<OffsetPlanner, 3> planner_{OffsetPlanner{40.0, kAcceleration_mm_s2},
                                        OffsetPlanner{40.0, kAcceleration_mm_s2},
                                        OffsetPlanner{40.0, kAcceleration_mm_s2}};
  std::uint64_t tick_ = 0;
};

/// The LinuxCNC mill at full feed: no error is too large for its limit, so only offsets act.
Machine mill() {
  Machine machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  machine.contour.limit_mm = 5.0;
  machine.envelope.max_path_offset_mm = 2.0;
  machine.envelope.path_offset_slew_mm_s = 100.0;
  return machine;
}

struct Cut {
  double rms_mm = 0.0;
  double largest_mm = 0.0;
  double duration_s = 0.0;
};

Cut cut(const std::string& text, bool with_offsets) {
  const Machine machine = mill();
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  const auto path = std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(text, config, machine, "part.ngc").value());
  const auto simulated = sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
  SlowOffsets port(*simulated);
  auto layer = supervisor::Supervisor::make(machine, port.capability()).value();
  layer.set_mode(with_offsets ? kernel::machine::Mode::act : kernel::machine::Mode::observe);
  Cut out;
  std::size_t cutting = 0;
  while (!simulated->finished()) {
    EXPECT_TRUE(layer.cycle(port, {}).has_value());
    const auto& contour = layer.estimates().contour;
    if (!contour || !contour->error_valid) {
      continue;
    }
    ++cutting;
    out.rms_mm += contour->error_mm * contour->error_mm;
    out.largest_mm = std::max(out.largest_mm, std::abs(contour->error_mm));
    out.duration_s = 0.001 * static_cast<double>(cutting);
  }
  out.rms_mm = std::sqrt(out.rms_mm / static_cast<double>(std::max<std::size_t>(1, cutting)));
  return out;
}

const std::string kHead = "G21 G90 G94 G17\nM52 P1\nG0 X0 Y0 Z0\n";

struct Part {
  const char* name;
  const char* piece;  ///< relative moves, cut over and over
  int times;
  double share;  ///< of the error without offsets that must not be passed
};

class PartWithCorners : public testing::TestWithParam<Part> {};

// Half a millimetre takes 71 ms; the error of a corner lasts 1/k = 50 ms.
TEST_P(PartWithCorners, IsNoWorseWithSlowOffsets) {
  for (const std::string mode : {"G61", "G64 P0.005", "G64 P0.05"}) {
    for (const int feed : {1800, 2500}) {
      std::string text = kHead + mode + "\nG91\nF" + std::to_string(feed) + "\n";
      for (int i = 0; i < GetParam().times; ++i) {
        text += GetParam().piece;
      }
      const Cut without = cut(text + "M2\n", false);
      const Cut with = cut(text + "M2\n", true);
      EXPECT_GT(without.rms_mm, 0.01) << mode << feed;
      EXPECT_LT(with.rms_mm, GetParam().share * without.rms_mm) << mode << ' ' << feed;
      EXPECT_LT(with.largest_mm, 1.25 * without.largest_mm) << mode << ' ' << feed;
      EXPECT_NEAR(with.duration_s, without.duration_s, 0.01 * without.duration_s) << "full feed";
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    SlowOffsets, PartWithCorners,
    testing::Values(Part{"pocket", "G1 X8\nY3\nX-8\nY-3\nX8 Y3\nX-8 Y3\nY-6\n", 12, 0.985},
                    Part{"stairs", "G1 X.4\nY.4\nX.8\nY.4\n", 40, 1.001},
                    Part{"small_arcs", "G2 X1.2 R0.6\nG3 X1.2 R0.6\n", 30, 1.002},
                    Part{"saw", "G1 X.45 Y2\nX.45 Y-2\n", 30, 1.001},
                    Part{"teeth", "G1 X.05\nX.05\nX.05 Y.3\nX.05 Y-.3\n", 60, 1.001}),
    [](const auto& part) { return std::string(part.param.name); });

TEST(SlowOffsets, StillCancelTheErrorOfACircle) {
  const std::string text = kHead + "G61\nG1 X10 Y-30 F4000\nY0\nG3 X10 Y0 I-10 J0 P6\nM2\n";
  const Cut without = cut(text, false);
  const Cut with = cut(text, true);
  EXPECT_GT(without.rms_mm, 0.3);
  EXPECT_LT(with.rms_mm, 0.1 * without.rms_mm);
  EXPECT_LT(with.largest_mm, 0.5 * without.largest_mm);
}

}  // namespace
}  // namespace steadyrest
