// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// Who asks.
enum class Room : std::uint8_t { motion, contour, chatter, thermal };

/// A room's request for the feed override. Ratio 1.0 (as programmed) with Reason::none is the
/// neutral request.
struct FeedRequest {
  Room room = Room::contour;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// A room's request for the spindle override.
struct SpindleRequest {
  Room room = Room::chatter;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// No slope requested: only the envelope's slew applies.
[[nodiscard]] constexpr AxisValues any_slope() noexcept {
  AxisValues any{};
  any.fill(std::numeric_limits<double>::infinity());
  return any;
}

/// A room's request for offsets to the axes' commanded positions: the final values. The envelope
/// leads the axes there.
struct OffsetRequest {
  Room room = Room::thermal;
  AxisValues offset_mm{};
  AxisValues slope_mm_s = any_slope();  ///< ≥ 0; no axis moves faster than this; 0 holds it
  bool tool_in_cut = false;
  outcome::Reason reason = outcome::Reason::none;
};

}  // namespace steadyrest::kernel::signal
