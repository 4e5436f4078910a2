// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {

namespace {

using kernel::units::kTurn;

}

double Process::entry_rad() const noexcept {
  if (cut.operation == Operation::turning || cut.direction == Direction::up) {
    return 0.0;
  }
  // Angles from the normal to the feed, in the direction of rotation: up milling starts with zero
  // chip thickness at 0, down milling ends with it at π. The two formulas agree at a/D = 0.5; only
  // other immersions reveal a mix-up.
  return std::acos(std::clamp(2.0 * cut.radial_immersion - 1.0, -1.0, 1.0));
}

double Process::exit_rad() const noexcept {
  if (cut.operation == Operation::turning) {
    return kTurn;
  }
  return cut.direction == Direction::down
             ? std::numbers::pi
             : std::acos(std::clamp(1.0 - 2.0 * cut.radial_immersion, -1.0, 1.0));
}

double Process::pitch_rad(std::size_t tooth) const noexcept {
  return tool.pitch_rad.empty() ? kTurn / static_cast<double>(tool.teeth) : tool.pitch_rad[tooth];
}

bool Process::even_pitch() const noexcept {
  return std::ranges::all_of(tool.pitch_rad, [&](double pitch) {
    return std::abs(pitch - kTurn / static_cast<double>(tool.teeth)) < 1e-12;
  });
}

}  // namespace steadyrest::chatter::offline
