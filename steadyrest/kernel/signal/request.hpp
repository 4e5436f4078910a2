// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// Who asks.
enum class Room : std::uint8_t { motion, contour, chatter, thermal };

/// What a room wants of the feed override. ratio 1.0 = as programmed; that and Reason::none is the
/// neutral request.
struct FeedRequest {
  Room room = Room::contour;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// What a room wants of the spindle override.
struct SpindleRequest {
  Room room = Room::chatter;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// No slope is asked for: the envelope's slew alone holds.
[[nodiscard]] constexpr AxisValues any_slope() noexcept {
  AxisValues any{};
  any.fill(std::numeric_limits<double>::infinity());
  return any;
}

/// What a room wants to add to the axes' commanded positions: where they should be in the end. The
/// envelope leads them there.
struct OffsetRequest {
  Room room = Room::thermal;
  AxisValues offset_mm{};
  AxisValues slope_mm_s = any_slope();  ///< ≥ 0; no axis moves faster than this; 0 holds it
  bool tool_in_cut = false;
  outcome::Reason reason = outcome::Reason::none;
};

}  // namespace steadyrest::kernel::signal
