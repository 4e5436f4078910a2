// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/trial/cut/true_error.hpp>

// The judge: the product's own foot search, fed with what no control can see.
namespace steadyrest::trial::cut {
namespace {

using contour::online::ContourError;
using kernel::outcome::Result;
using kernel::signal::Frame;
using kernel::signal::Point;

Point xyz_of(const kernel::signal::AxisValues& values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

Result<TrueError> TrueError::make(const kernel::machine::Machine& machine,
                                  std::shared_ptr<const Original> original) {
  ContourError::Config config;
  // The slowest axis lags most.
  config.servo_gain_1_s = std::ranges::min(machine.axes, {}, [](const auto& axis) {
                            return axis.servo_gain_1_s;
                          }).servo_gain_1_s;
  auto own = ContourError::make(config);
  if (!own) {
    return std::unexpected(own.error());
  }
  config.reserve_mm += original ? original->pairing.slack_mm() : 0.0;
  auto other = ContourError::make(config);
  if (!other) {
    return std::unexpected(other.error());
  }
  return TrueError(*own, *other, std::move(original));
}

TrueError::Output TrueError::update(const Frame& frame, const sim::Truth& truth) noexcept {
  ContourError::Input input = contour::online::contour_input(frame);
  input.command_mm = xyz_of(truth.program_mm);
  input.actual_mm = xyz_of(truth.tool_mm);
  Output out{.own = own_.update(input), .original = {}};
  if (original_) {
    out.original = other_.update(contour::online::moved_to(
        input, original_->path->segments, original_->pairing.original_mm(input.path_position_mm)));
  }
  return out;
}

}  // namespace steadyrest::trial::cut
