// SPDX-License-Identifier: Apache-2.0
// Contour error cancelled by offsets on a control that moves them slowly, as LinuxCNC does with its
// share of the axis's acceleration: never worse than without, and better where there is time.
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

// Half a millimetre takes 71 ms; the error of a corner lasts 1/k = 50 ms.
TEST(SlowOffsets, MakeAPartWithSharpCornersNoWorse) {
  for (const std::string mode : {"G61", "G64 P0.05"}) {
    std::string text = kHead + mode + "\n";
    for (int i = 0; i < 12; ++i) {
      text += "G1 X8 F1800\nY3\nX0\nY0\nX8 Y3\nX0 Y6\nX0 Y0\n";
    }
    const Cut without = cut(text + "M2\n", false);
    const Cut with = cut(text + "M2\n", true);
    EXPECT_GT(without.rms_mm, 0.02) << mode;
    EXPECT_LT(with.rms_mm, 0.95 * without.rms_mm) << mode;
    EXPECT_LT(with.largest_mm, 1.02 * without.largest_mm) << mode;
    EXPECT_NEAR(with.duration_s, without.duration_s, 0.01 * without.duration_s) << "full feed";
  }
}

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
