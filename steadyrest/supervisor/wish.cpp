// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/supervisor/wish.hpp>

namespace steadyrest::supervisor {
namespace {

using chatter::online::Modulation;
using kernel::outcome::Reason;

WishOutcome grant_modulation(Supervisor& layer, const Modulation& modulation) noexcept {
  if (layer.modulation() == nullptr) {
    return WishOutcome::room_off;
  }
  if (layer.listens()) {
    return WishOutcome::listening;
  }
  return layer.modulate(modulation) ? WishOutcome::taken : WishOutcome::out_of_range;
}

WishOutcome grant_reading(Supervisor& layer, const Measured& measured) noexcept {
  auto* const room = layer.thermal();
  if (room == nullptr) {
    return WishOutcome::room_off;
  }
  const auto verdict = room->measure(
      measured.axis, {.displacement_mm = measured.displacement_mm, .sd_mm = measured.sd_mm});
  switch (verdict.reason) {
    case Reason::thermal_reading_taken:
      return WishOutcome::taken;
    case Reason::thermal_reading_outlier:
      return WishOutcome::rejected;
    case Reason::none:
      return WishOutcome::no_model;
    default:
      return WishOutcome::out_of_range;
  }
}

}  // namespace

WishOutcome grant(Supervisor& layer, const Wish& wish) noexcept {
  if (const auto* const modulation = std::get_if<Modulation>(&wish.what)) {
    return grant_modulation(layer, *modulation);
  }
  const auto* const measured = std::get_if<Measured>(&wish.what);
  return measured != nullptr ? grant_reading(layer, *measured) : WishOutcome::out_of_range;
}

}  // namespace steadyrest::supervisor
